#include <butee/plugin/entry.hpp>

#include "integrators/methods.hpp"

BUTEE_PLUGIN(registrar) {
  registrar.add(butee::integrators::central_differences_type());
  registrar.add(butee::integrators::central_differences_adaptive_type());
}

#include <butee/plugin/entry.hpp>

#include "integrators/methods.hpp"

BUTEE_PLUGIN(registrar) {
  registrar.add(butee::integrators::bathe_type());
  registrar.add(butee::integrators::bathe_adaptive_type());
}

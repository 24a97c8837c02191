#include <butee/plugin/entry.hpp>

#include "integrators/methods.hpp"

BUTEE_PLUGIN(registrar) {
  registrar.add(butee::integrators::generalized_alpha_type());
  registrar.add(butee::integrators::generalized_alpha_adaptive_type());
}

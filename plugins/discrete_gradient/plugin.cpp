#include <butee/plugin/entry.hpp>

#include "integrators/methods.hpp"

BUTEE_PLUGIN(registrar) {
  registrar.add(butee::integrators::discrete_gradient_type());
  registrar.add(butee::integrators::discrete_gradient_adaptive_type());
}

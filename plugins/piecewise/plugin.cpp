#include <butee/plugin/entry.hpp>

#include "integrators/methods.hpp"

BUTEE_PLUGIN(registrar) {
  registrar.add(butee::integrators::piecewise_type());
}

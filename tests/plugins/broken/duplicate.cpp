#include <butee/plugin/entry.hpp>

BUTEE_PLUGIN(registrar) {
  registrar.add({"mine", {"RK4-1"}, "takes an alias that is taken", {}, 0.0, {}, {}});
}

#include <butee/plugin/entry.hpp>

BUTEE_PLUGIN(registrar) {
  registrar.add({.name = "mine", .aliases = {"RK4-1"}, .summary = "takes an alias that is taken"});
}

#include <butee/plugin/abi.hpp>
#include <butee/plugin/registrar.hpp>

extern "C" __attribute__((visibility("default"))) const butee_abi_tag* butee_plugin_abi() {
  static const butee_abi_tag tag = [] {
    butee_abi_tag made = butee::plugin::abi_tag();
    made.interface_version += 7;
    made.eigen_alignment = 16;
    return made;
  }();
  return &tag;
}

extern "C" __attribute__((visibility("default"))) void butee_plugin_register(butee::plugin::Registrar*) {
  __builtin_trap();
}

#pragma once

#include "butee/plugin/abi.hpp"
#include "butee/plugin/registrar.hpp"

/// The entry points of a module: one C function for the tag, one for the registration.
///
///     BUTEE_PLUGIN(registrar) { registrar.add(my_method_type()); }
#define BUTEE_PLUGIN(registrar)                                                                                \
  static void butee_plugin_register_types(butee::plugin::Registrar& registrar);                                \
  extern "C" __attribute__((visibility("default"))) const butee_abi_tag* butee_plugin_abi() {                  \
    static const butee_abi_tag tag = butee::plugin::abi_tag();                                                 \
    return &tag;                                                                                               \
  }                                                                                                            \
  extern "C" __attribute__((visibility("default"))) void butee_plugin_register(butee::plugin::Registrar* to) { \
    butee_plugin_register_types(*to);                                                                          \
  }                                                                                                            \
  static void butee_plugin_register_types(butee::plugin::Registrar& registrar)

#include "butee/plugin/module.hpp"

#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/version.hpp"

PYBIND11_MODULE(_butee, module) {
  using namespace butee::python;
  module.doc() = "Extension module of the package butee; import butee instead.";
  module.attr("version") = BUTEE_VERSION;
  module.attr("plugin_folder") = butee::plugin::standard_plugin_folder();
  module.attr("lib_to_program") = BUTEE_LIB_TO_PROGRAM;
  bind_end_of_interpreter();
  bind_errors(module);
  bind_loads(module);
  bind_laws(module);
  bind_conformance(module);
  bind_scene(module);
  bind_outcome(module);
  bind_batch(module);
  bind_study(module);
  bind_equations(module);
  bind_structure(module);
}

#include <pybind11/stl.h>

#include "butee/config/file_reference.hpp"
#include "butee/config/override.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/document_bytes.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/python_loads.hpp"
#include "butee/python/session.hpp"
#include "butee/python/values.hpp"
#include "butee/python/watch.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using Strings = std::vector<std::string>;

Session load(const std::string& path, const Strings& overrides, const Strings& plugins) {
  const plugin::Catalogue catalogue = catalogue_with(plugins);
  const WithoutInterpreter unlocked;
  config::Document document = config::load_toml(path);
  for (const std::string& assignment : overrides) config::apply_override(document, assignment);
  return {std::move(document), plugins, catalogue};
}

Session from_toml(const std::string& text, const std::string& name, const Strings& plugins) {
  const plugin::Catalogue catalogue = catalogue_with(plugins);
  const WithoutInterpreter unlocked;
  return {config::parse_toml(text, name), plugins, catalogue};
}

Session from_dict(py::handle dict, const std::string& name, const Strings& plugins) {
  config::Document document{{name}, to_value(dict)};
  if (document.root.table() == nullptr) throw py::type_error("a scene is a dict of its tables");
  const plugin::Catalogue catalogue = catalogue_with(plugins);
  const WithoutInterpreter unlocked;
  return {std::move(document), plugins, catalogue};
}

/// None removes a key.
std::vector<Assignment> to_assignments(const py::dict& values) {
  std::vector<Assignment> assignments;
  for (const auto& [key, value] : values) {
    if (!py::isinstance<py::str>(key))
      throw py::type_error("a key must be a string, such as \"contact[0].gap\", not " +
                           py::repr(key).cast<std::string>());
    assignments.emplace_back(key.cast<std::string>(), value.is_none() ? std::nullopt : std::optional(to_value(value)));
  }
  return assignments;
}

Session with(const Session& session, const py::dict& values) {
  const auto assignments = to_assignments(values);
  const Session copy = session;
  const WithoutInterpreter unlocked;
  return copy.with(assignments);
}

std::shared_ptr<Outcome> run(const Session& session, py::object progress, bool progress_bar, const std::string& folder,
                             bool resume) {
  PythonWatch watch(std::move(progress));
  const auto scene = session.shared();
  std::shared_ptr<Outcome> outcome;
  {
    const WithoutInterpreter unlocked;
    outcome = perform(*scene, {progress_bar, folder, resume}, watch);
  }
  watch.rethrow();
  if (take_interrupt()) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return outcome;
}

py::object find(const Session& session, const std::string& key) {
  const config::Value* value = config::find_value(session.document(), key);
  if (value == nullptr) throw py::key_error(key);
  return to_python(*value);
}

py::bytes state_of(const Session& session) {
  const auto bytes = to_bytes(session.document());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Session from_state(const std::string& bytes, const Strings& plugins) {
  return {to_document(std::as_bytes(std::span(bytes))), plugins, catalogue_with(plugins)};
}

std::string text_for(const Session& session, const std::string& folder) {
  if (folder.empty()) return config::write_toml(*session.document().root.table());
  return config::write_toml(config::with_files_found_from(session.document(), folder));
}

}  // namespace

void bind_scene(py::module_& module) {
  module.def("load", &load);
  module.def("from_toml", &from_toml);
  module.def("from_dict", &from_dict);
  module.def("from_state", &from_state);
  module.def("toml", [](const py::dict& tables) { return config::write_toml(*to_value(tables).table()); });
  py::class_<Session> type(module, "Session");
  type.def("with_values", &with)
      .def("find", &find)
      .def("contains",
           [](const Session& s, const std::string& key) { return config::find_value(s.document(), key) != nullptr; })
      .def("to_dict", [](const Session& s) { return to_python(s.document().root); })
      .def("to_toml", &text_for)
      .def("state", &state_of)
      .def("run", &run)
      .def_property_readonly("plugins", &Session::plugins)
      .def_property_readonly("name", [](const Session& s) { return s.document().sources.front(); })
      .def_property_readonly("title", [](const Session& s) { return s.scene().model.title; })
      .def_property_readonly("method", [](const Session& s) { return s.scene().integrator.name; })
      .def_property_readonly("end_time", [](const Session& s) { return s.scene().integrator.options.end_time; })
      .def_property_readonly("warnings", [](const Session& s) { return s.scene().warnings; });
  seal(type);
}

}  // namespace butee::python

#include "butee/python/python_loads.hpp"

#include <pybind11/stl.h>

#include "butee/python/bindings.hpp"
#include "butee/python/python_laws.hpp"
#include "butee/python/shared_function.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

/// The time function of a load as a Python function: f(t, parameters...).
class PythonLoad final : public model::TimeFunction {
 public:
  PythonLoad(std::shared_ptr<py::function> function, std::vector<double> parameters)
      : function_(std::move(function)), parameters_(std::move(parameters)) {}

  double value(double t) const override { return call_with(*function_, t, parameters_); }

 private:
  std::shared_ptr<py::function> function_;
  std::vector<double> parameters_;
};

/// The loads registered by the program; changed only with the interpreter's lock.
std::vector<model::LoadType>& registered() {
  static auto* types = new std::vector<model::LoadType>;  // lives as long as the interpreter, which may outlive statics
  return *types;
}

void register_load(const std::string& name, const py::function& function, const DeclaredParameters& parameters,
                   const std::string& summary) {
  model::LoadType type{name, summary, {}, nullptr};
  const std::vector<std::string> names = declare(parameters, type.parameters);
  type.make = [held = shared_function(function), names](const config::Parameters& given, config::Diagnostics&) {
    std::vector<double> values;
    for (const std::string& one : names) values.push_back(given.number(one));
    return std::make_unique<PythonLoad>(held, std::move(values));
  };
  std::erase_if(registered(), [&](const model::LoadType& other) { return other.name == name; });
  plugin::Catalogue::with_plugins().add({.loads = {type}}, "Python");  // throws if the name is taken
  registered().push_back(std::move(type));
}

}  // namespace

plugin::Catalogue catalogue_with(const std::vector<std::string>& plugins) {
  auto catalogue = plugin::Catalogue::with_plugins(plugins);
  if (!registered().empty() || !python_laws().empty())
    catalogue.add({.laws = python_laws(), .loads = registered()}, "Python");
  return catalogue;
}

void bind_loads(py::module_& module) {
  module.def("register_load", &register_load);
}

}  // namespace butee::python

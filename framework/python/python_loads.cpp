#include "butee/python/python_loads.hpp"

#include <pybind11/stl.h>

#include "butee/python/bindings.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

/// A function of Python, whose last reference any thread may drop.
std::shared_ptr<py::function> shared_function(const py::function& function) {
  return {new py::function(function), [](py::function* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

/// The course of a load as a function of Python: f(t, parameters...).
class PythonLoad final : public model::TimeFunction {
 public:
  PythonLoad(std::shared_ptr<py::function> function, std::vector<double> parameters)
      : function_(std::move(function)), parameters_(std::move(parameters)) {}

  double value(double t) const override {
    const py::gil_scoped_acquire lock;
    py::tuple arguments(parameters_.size() + 1);
    arguments[0] = t;
    for (std::size_t i = 0; i < parameters_.size(); ++i) arguments[i + 1] = parameters_[i];
    return (*function_)(*arguments).cast<double>();
  }

 private:
  std::shared_ptr<py::function> function_;
  std::vector<double> parameters_;
};

/// What the program had registered; changed with the interpreter's lock alone.
std::vector<model::LoadType>& registered() {
  static auto* types = new std::vector<model::LoadType>;  // as long as the interpreter, which may outlive statics
  return *types;
}

void register_load(const std::string& name, const py::function& function,
                   const std::vector<std::pair<std::string, std::optional<double>>>& parameters,
                   const std::string& summary) {
  model::LoadType type{name, summary, {}, nullptr};
  std::vector<std::string> names;
  for (const auto& [parameter, value] : parameters) {
    const config::Parameter declared = config::number(parameter, "", "of the function in Python");
    type.parameters.push_back(value ? declared.or_else(*value) : declared);
    names.push_back(parameter);
  }
  type.make = [held = shared_function(function), names](const config::Parameters& given, config::Diagnostics&) {
    std::vector<double> values;
    for (const std::string& one : names) values.push_back(given.number(one));
    return std::make_unique<PythonLoad>(held, std::move(values));
  };
  std::erase_if(registered(), [&](const model::LoadType& other) { return other.name == name; });
  plugin::Catalogue::with_plugins().add({.loads = {type}}, "Python");  // throws where a name is taken
  registered().push_back(std::move(type));
}

}  // namespace

plugin::Catalogue catalogue_with(const std::vector<std::string>& plugins) {
  auto catalogue = plugin::Catalogue::with_plugins(plugins);
  if (!registered().empty()) catalogue.add({.loads = registered()}, "Python");
  return catalogue;
}

void bind_loads(py::module_& module) {
  module.def("register_load", &register_load);
}

}  // namespace butee::python

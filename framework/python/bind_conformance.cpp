#include <pybind11/stl.h>

#include "apps/conformance/check.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/python_laws.hpp"
#include "butee/python/python_loads.hpp"
#include "butee/python/values.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

template <class Type>
std::vector<std::string> names_of(const std::vector<Type>& types) {
  std::vector<std::string> names;
  for (const Type& type : types) names.push_back(type.name);
  return names;
}

/// (name, demand, passed, details) for each check of the suite of `butee test-plugin` on a law or a
/// load.
py::list conformance(const std::string& name, const py::dict& keys) {
  const plugin::Catalogue catalogue = catalogue_with({});
  const auto laws = names_of(catalogue.types().laws), loads = names_of(catalogue.types().loads);
  const auto is_one_of = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!is_one_of(laws) && !is_one_of(loads)) {
    std::vector<std::string> all = laws;
    all.insert(all.end(), loads.begin(), loads.end());
    throw InputError("there is no law or load \"" + name + "\"" + suggestion(name, all) + "; known: " + join(all));
  }
  const auto checks = is_one_of(laws) ? conformance::law_checks() : conformance::load_checks();
  const conformance::Subject subject{catalogue, is_one_of(laws) ? "law" : "load", name,
                                     config::write_toml(*to_value(keys).table())};
  py::list findings;
  for (const conformance::Check& check : checks) {
    conformance::Finding finding{false, ""};
    {
      const WithoutInterpreter unlocked;
      finding = check.run(subject);
    }
    findings.append(py::make_tuple(check.name, check.demand, finding.passed, finding.details));
  }
  return findings;
}

}  // namespace

void bind_conformance(py::module_& module) {
  module.def("conformance", &conformance);
}

}  // namespace butee::python

#include <algorithm>
#include <limits>
#include <pybind11/stl.h>

#include "butee/core/text.hpp"
#include "butee/python/bindings.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

py::dict views(const Columns& columns, py::handle owner) {
  py::dict found;
  for (std::size_t i = 0; i < columns.names.size(); ++i)
    found[py::str(columns.names[i])] = view(columns.values[i], owner);
  return found;
}

py::array column(const Outcome& outcome, const std::string& name, py::handle owner) {
  const auto& names = outcome.history.names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw py::key_error(name + suggestion(name, names) + "; the columns are " + join(names));
  return view(outcome.history.values[static_cast<std::size_t>(found - names.begin())], owner);
}

py::list impacts(const Outcome& outcome) {
  py::list rows;
  for (const record::Impact& impact : outcome.impacts)
    rows.append(py::make_tuple(impact.node, impact.side, impact.t_in, impact.t_out.value_or(kNone), impact.peak_force,
                               impact.impulse, impact.impact_speed, impact.tangential_impulse, impact.slip,
                               impact.dissipated, impact.dof));
  return rows;
}

std::vector<double> numbers_of(const py::array_t<double, py::array::c_style | py::array::forcecast>& array) {
  return {array.data(), array.data() + array.size()};
}

Columns columns_of(const py::dict& from) {
  Columns columns({});
  for (const auto& [name, array] : from) {
    columns.names.push_back(name.cast<std::string>());
    columns.values.push_back(numbers_of(array.cast<py::array>()));
  }
  return columns;
}

/// Makes an Outcome from the values of bind_outcome's properties, for pickles.
std::shared_ptr<Outcome> made(const py::dict& history, const py::dict& energy, const py::list& rows,
                              const std::string& title, const std::string& summary, bool completed,
                              const std::string& message, const std::vector<std::string>& warnings,
                              const std::string& wear) {
  auto outcome = std::make_shared<Outcome>();
  outcome->history = columns_of(history);
  outcome->energy = columns_of(energy);
  outcome->title = title;
  outcome->summary = summary;
  outcome->completed = completed;
  outcome->message = message;
  outcome->warnings = warnings;
  outcome->wear = wear;
  for (const py::handle item : rows) {
    const auto row = item.cast<py::tuple>();
    const auto number = [&](std::size_t i) { return row[i].cast<double>(); };
    record::Impact impact;
    impact.node = row[0].cast<std::string>();
    impact.side = row[1].cast<int>();
    impact.t_in = number(2);
    impact.peak_force = number(4);
    impact.impulse = number(5);
    impact.impact_speed = number(6);
    impact.tangential_impulse = number(7);
    impact.slip = number(8);
    impact.dissipated = number(9);
    impact.dof = row[10].cast<std::string>();
    if (const double t_out = number(3); t_out == t_out) impact.t_out = t_out;
    outcome->impacts.push_back(std::move(impact));
  }
  return outcome;
}

}  // namespace

void bind_outcome(py::module_& module) {
  module.def("outcome", &made);
  py::class_<Outcome, std::shared_ptr<Outcome>> type(module, "Outcome");
  type.def("column", &column)
      .def_property_readonly("columns", [](const Outcome& o) { return o.history.names; })
      .def("history", [](const Outcome& o, py::handle owner) { return views(o.history, owner); })
      .def("energy", [](const Outcome& o, py::handle owner) { return views(o.energy, owner); })
      .def("impacts", &impacts)
      .def_readonly("title", &Outcome::title)
      .def_readonly("summary", &Outcome::summary)
      .def_readonly("completed", &Outcome::completed)
      .def_readonly("message", &Outcome::message)
      .def_readonly("wear", &Outcome::wear)
      .def_readonly("warnings", &Outcome::warnings);
  seal(type);
}

}  // namespace butee::python

#include <pybind11/stl.h>

#include "butee/core/error.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/part.hpp"
#include "butee/python/watch.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Snapshot = embed::Structure::Snapshot;

Vector checked_numbers(const Array& array, Index size, const char* name) {
  if (array.ndim() != 1 || array.size() != size)
    throw py::value_error(std::string(name) + " has to be an array of shape (" + std::to_string(size) + ",)");
  return Eigen::Map<const Vector>(array.data(), size);
}

/// Checks all numbers before the first is set.
void check_finite(const Vector& numbers, const std::string& name = "a force") {
  if (!(numbers.array().abs() <= embed::Structure::kLargestNumber).all())
    throw py::value_error(name + " has to be a finite number of at most 1e100");
}

/// A read-only copy.
py::array_t<double> array_of(const Vector& values) {
  py::array_t<double> array(static_cast<py::ssize_t>(values.size()), values.data());
  make_read_only(array);
  return array;
}

void advance_to(Part& part, double t) {
  PythonWatch watch{py::none()};
  bool done = false;
  {
    const WithoutInterpreter unlocked;
    const auto locked = part.use();
    done = locked->advance_to(t, [&] { return watch.look(t) == nullptr; });
  }
  if (!done) watch.rethrow();
}

double advance_step(Part& part, double limit) {
  const WithoutInterpreter unlocked;
  return part.use()->advance_step(limit);
}

void set_forces(Part& part, const Array& values) {
  const auto& dofs = part.forced_dofs();
  const auto n = static_cast<Index>(dofs.size());
  const Vector numbers = checked_numbers(values, n, "forces");
  const auto locked = part.use();
  check_finite(numbers);
  for (Index i = 0; i < n; ++i) locked->set_force(dofs[static_cast<std::size_t>(i)], numbers[i]);
}

void set_lines(Part& part, const Array& from, const Array& to, double until) {
  const auto& dofs = part.forced_dofs();
  const auto n = static_cast<Index>(dofs.size());
  const Vector begin = checked_numbers(from, n, "the first forces"), end = checked_numbers(to, n, "the last forces");
  const auto locked = part.use();
  check_finite(begin);
  check_finite(end);
  // All or nothing: Structure::set_force() would refuse such a slope after it has set the forces before.
  if (const double h = until - locked->time(); h > 0.0) check_finite((end - begin) / h, "the slope of a force");
  for (Index i = 0; i < n; ++i) locked->set_force(dofs[static_cast<std::size_t>(i)], begin[i], end[i], until);
}

py::array_t<double> forces(Part& part) {
  const auto locked = part.use();
  Vector values(static_cast<Index>(part.forced_dofs().size()));
  for (Index i = 0; i < values.size(); ++i) values[i] = locked->force(part.forced_dofs()[static_cast<std::size_t>(i)]);
  return array_of(values);
}

void set_motion(Part& part, const Array& x, const Array& v) {
  const auto locked = part.use();
  const Vector displacements = checked_numbers(x, locked->size(), "the displacements"),
               velocities = checked_numbers(v, locked->size(), "the velocities");
  locked->set_motion(displacements, velocities);
}

/// A copy of a member of the state, since the structure's own vector changes with every step.
template <Vector time::State::*Member>
py::array_t<double> state_of(Part& part) {
  return array_of(part.use()->state().*Member);
}

DofKind kind_named(const std::string& name) {
  if (const auto kind = dof_named(name)) return *kind;
  throw InputError("there is no degree of freedom \"" + name + "\"");
}

std::vector<std::string> dof_names(Part& part) {
  const auto locked = part.use();
  std::vector<std::string> names;
  for (Index i = 0; i < locked->size(); ++i) names.push_back(locked->dof_name(i));
  return names;
}

py::dict energy_of(Part& part) {
  const record::Energy energy = part.use()->energy();
  return py::dict(py::arg("kinetic") = energy.kinetic, py::arg("strain") = energy.strain,
                  py::arg("contact") = energy.contact);
}

py::bytes bytes_of(const Snapshot& snapshot) {
  const auto bytes = to_bytes(snapshot);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Snapshot snapshot_of(const py::bytes& bytes) {
  const auto text = bytes.cast<std::string>();
  return to_snapshot(std::as_bytes(std::span(text)));
}

}  // namespace

void bind_structure(py::module_& module) {
  module.def("part", [](const Session& session, std::vector<std::string> forced) {
    const WithoutInterpreter unlocked;
    return std::make_unique<Part>(session, std::move(forced));
  });
  module.def("snapshot", &snapshot_of);
  py::class_<Snapshot> snapshot(module, "Snapshot", "A saved state of a Structure, from Structure.snapshot().");
  snapshot
      .def_property_readonly(
          "time", [](const Snapshot& s) { return s.run.state.t; }, "The instant, s.")
      .def("__reduce__", [](const Snapshot& s) {
        return py::make_tuple(py::module_::import("butee._structure").attr("_snapshot_of"),
                              py::make_tuple(bytes_of(s)));
      });
  seal(snapshot);
  py::class_<Part> part(module, "Part");
  part.def("advance_to", &advance_to)
      .def("advance_step", &advance_step)
      .def("set_forces", &set_forces)
      .def("set_lines", &set_lines)
      .def("set_force", [](Part& p, Index dof, double value) { p.use()->set_force(dof, value); })
      .def("set_line",
           [](Part& p, Index dof, double from, double to, double until) { p.use()->set_force(dof, from, to, until); })
      .def("forces", &forces)
      .def("force", [](Part& p, Index dof) { return p.use()->force(dof); })
      .def("contact_force", [](Part& p, Index dof) { return p.use()->contact_force(dof); })
      .def("set_motion", &set_motion)
      .def("x", &state_of<&time::State::x>)
      .def("v", &state_of<&time::State::v>)
      .def("a", &state_of<&time::State::a>)
      .def("displacement", [](Part& p, Index dof) { return p.use()->displacement(dof); })
      .def("velocity", [](Part& p, Index dof) { return p.use()->velocity(dof); })
      .def("acceleration", [](Part& p, Index dof) { return p.use()->acceleration(dof); })
      .def("quantity", [](Part& p, const std::string& name, const std::string& node,
                          const std::string& element) { return p.use()->quantity(name, node, element); })
      .def("dof", [](Part& p, const std::string& node,
                     const std::string& kind) { return p.use()->dof(node, kind_named(kind)); })
      .def("dof_list", [](Part& p, const std::string& nodes,
                          const std::string& kind) { return p.use()->dofs(nodes, kind_named(kind)); })
      .def("dof_names", &dof_names)
      .def("forced_dofs", &Part::forced_dofs)
      .def("time", [](Part& p) { return p.use()->time(); })
      .def("energy", &energy_of)
      .def("method", [](Part& p) { return p.use()->method(); })
      .def("steps", [](Part& p) { return p.use()->report().steps; })
      .def("snapshot", [](Part& p) { return p.use()->snapshot(); })
      .def("restore", [](Part& p, const Snapshot& s) { p.use()->restore(s); })
      .def("session", [](Part& p) { return p.session(); })
      .def("forced", &Part::forced);
  seal(part);
}

}  // namespace butee::python

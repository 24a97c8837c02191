#include <mutex>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_damping.hpp"
#include "butee/dynamics/mode_analysis.hpp"
#include "butee/python/bindings.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/session.hpp"
#include "butee/scene/assembly.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// M a + C v + K x = F(t) + F_c(x) for a scene.
class Equations {
 public:
  explicit Equations(const Session& session) : scene_(session.shared()), assembled_(scene_->model) {}

  const model::System& system() const { return assembled_.system; }

  SparseMatrix damping(double t) const {
    const model::Damping& given = system().damping;
    SparseMatrix sum = given.mass_proportional * system().mass + given.stiffness_proportional * system().stiffness;
    if (system().dashpots.size() > 0) sum += system().dashpots;
    if (const auto modal = dynamics::ModalDamping::of(system()))
      sum += SparseMatrix((modal->factor() * modal->factor().transpose()).sparseView());
    if (system().rotation != nullptr && system().gyroscopic.size() > 0)
      sum += system().rotation->speed(t) * system().gyroscopic;
    return sum;
  }

  SparseMatrix stiffness(double t) const {
    SparseMatrix sum = system().stiffness;
    if (system().rotation == nullptr) return sum;
    if (system().circulatory.size() > 0) sum += system().rotation->speed(t) * system().circulatory;
    if (system().gyroscopic.size() > 0) sum += system().rotation->acceleration(t) * system().gyroscopic;
    return sum;
  }

  Vector external_force(double t) {
    return alone([&](Vector& force) { assembled_.dynamics.external_force(t, force); });
  }

  Vector contact_force(double t, const Array& x, const Array& v) {
    const auto at = checked(x, "x"), moving = checked(v, "v");
    return alone([&](Vector& force) { assembled_.dynamics.add_held_contact_force(t, at, moving, force); });
  }

  Vector acceleration(double t, const Array& x, const Array& v) {
    const auto at = checked(x, "x"), moving = checked(v, "v");
    return alone([&](Vector& a) { assembled_.dynamics.acceleration(t, at, moving, a); });
  }

  std::vector<std::string> dofs() const {
    std::vector<std::string> names;
    for (Index i = 0; i < system().size(); ++i) names.push_back(assembled_.dynamics.dof_name(i));
    return names;
  }

 private:
  Eigen::Map<const Vector> checked(const Array& array, const char* name) const {
    if (array.ndim() != 1 || array.size() != system().size())
      throw py::value_error(std::string(name) + " has to be an array of shape (" + std::to_string(system().size()) +
                            ",), one value for each of `dofs`");
    return {array.data(), array.size()};
  }

  /// Dynamics serves one thread at a time. A waiting thread does not hold the interpreter's lock,
  /// which loads may need.
  template <class Compute>
  Vector alone(const Compute& compute) {
    const WithoutInterpreter unlocked;
    const std::lock_guard lock(mutex_);
    Vector result = Vector::Zero(system().size());
    compute(result);
    return result;
  }

  std::shared_ptr<scene::Scene> scene_;
  scene::AssembledEquations assembled_;
  std::mutex mutex_;
};

py::dict modes_of(const Session& session, Index count, const std::vector<std::string>& closed) {
  const auto scene = session.shared();
  dynamics::ModeAnalysis found;
  {
    const WithoutInterpreter unlocked;
    const model::System system = assemble(scene->model);
    if (!system.stiffness_is_symmetric)
      throw InputError(
          "the stiffness matrix is not symmetric, because of cross terms of bearings or of given matrices, or of "
          "damping that turns, so that "
          "the scene has no undamped modes; whirl() gives damped modes");
    constexpr Index kDefaultCount = 10;  // as `butee modes`
    if (count == 0) count = std::min(kDefaultCount, system.size());
    found = analyse_modes(scene->model, system, dynamics::closed_stops(scene->model, closed), count);
  }
  const auto n = static_cast<py::ssize_t>(found.modes.size());
  const auto column = [&](auto value) {
    py::array_t<double> array(n);
    for (py::ssize_t i = 0; i < n; ++i) array.mutable_at(i) = value(found.modes[static_cast<std::size_t>(i)]);
    return array;
  };
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  py::dict result;
  result["angular_frequencies"] = column([](const auto& mode) { return mode.omega; });
  result["frequencies"] = column([](const auto& mode) { return mode.frequency; });
  result["damping_ratios"] = column([&](const auto& mode) { return mode.damping.value_or(kNone); });
  result["effective_masses"] = column([](const auto& mode) { return mode.effective_mass; });
  result["total_mass"] = found.total_mass;
  result["shapes"] = py::cast(std::move(found.shapes));
  return result;
}

}  // namespace

void bind_equations(py::module_& module) {
  module.def("modes", &modes_of);
  module.def("equations", [](const Session& session) { return std::make_unique<Equations>(session); });
  py::class_<Equations> equations(module, "Equations");
  equations.def("mass", [](const Equations& e) { return e.system().mass; })
      .def("damping", &Equations::damping)
      .def("stiffness", &Equations::stiffness)
      .def("external_force", &Equations::external_force)
      .def("contact_force", &Equations::contact_force)
      .def("acceleration", &Equations::acceleration)
      .def_property_readonly("dofs", &Equations::dofs)
      .def_property_readonly("x0", [](const Equations& e) { return e.system().initial_displacement; })
      .def_property_readonly("v0", [](const Equations& e) { return e.system().initial_velocity; })
      .def_property_readonly("t0", [](const Equations& e) { return e.system().initial_time; });
  seal(equations);
}

}  // namespace butee::python

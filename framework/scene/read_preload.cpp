#include <algorithm>
#include <cmath>

#include "butee/core/text.hpp"
#include "butee/dynamics/buckling.hpp"
#include "butee/dynamics/free_motion.hpp"
#include "butee/linalg/linear_solver.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {
namespace {

constexpr double kHold = 1e-12, kConverged = 1e-6;
constexpr int kRefinements = 4;

/// The static position under gravity, without stops and preloads; nothing if it does not exist.
std::optional<Vector> sag(const Load& gravity, const System& system) {
  Vector x = Vector::Zero(system.size());
  for (const NodalValue& entry : gravity.pattern)
    if (const Index dof = system.dofs.index(entry.dof); dof >= 0) x[dof] += entry.value * gravity.in_time->value(0.0);
  const Vector force = x;
  linalg::Counters counters;
  linalg::LinearSolver solver(system.stiffness, counters, nullptr, system.stiffness_is_symmetric);
  if (!solver.factorize(system.stiffness)) {
    // A hanging structure may swing freely: a small multiple of M makes K regular, and refinement
    // removes its effect.
    const double shift = kHold * system.stiffness.diagonal().cwiseQuotient(system.mass.diagonal()).maxCoeff();
    const SparseMatrix held = system.stiffness + shift * system.mass;
    if (!solver.factorize(held)) return std::nullopt;
  }
  x.setZero();
  for (int i = 0; i < kRefinements; ++i) {
    Vector rest = force - system.stiffness * x;
    solver.solve(rest);
    x += rest;
  }
  const bool is_found = x.allFinite() && (force - system.stiffness * x).norm() <= kConverged * force.norm();
  return is_found ? std::optional(x) : std::nullopt;
}

/// The axial force in the middle of a part, N: the mean of the values at its ends.
double axial_force(const SectionCut& cut, const SectionCut& begin, const System& system, const Vector& x) {
  Eigen::VectorXd own(std::ssize(cut.dofs));
  for (std::size_t i = 0; i < cut.dofs.size(); ++i) {
    const Index dof = system.dofs.index(cut.dofs[i]);
    own[static_cast<Index>(i)] = dof >= 0 ? x[dof] : 0.0;
  }
  const Eigen::VectorXd p = cut.matrices.stiffness * own;
  return 0.5 * (cut.resultants.row(0).dot(p) + begin.resultants.row(0).dot(p));
}

}  // namespace

void SceneReader::read_preload() {
  if (diagnostics_.error_count() > 0 || lacks_elements_) return;
  find_preload_of_gravity();
  if (diagnostics_.error_count() == 0) check_buckling();
}

void SceneReader::find_preload_of_gravity() {
  std::vector<std::size_t> beams;
  for (std::size_t i = 0; i < model_.elements.size(); ++i)
    if (model_.elements[i]->takes_preload_of_gravity()) beams.push_back(i);
  if (beams.empty()) return;
  const auto& [path, at] = element_places_[beams.front()];
  const std::string key = path + ".preload";
  if (!gravity_load_)
    return diagnostics_.error(key, at, "is \"gravity\", but there is none: give [gravity] with its acceleration");
  const System system = assemble(model_, TurningParts::apart);
  const auto x = sag(model_.loads[*gravity_load_], system);
  if (!x)
    return diagnostics_.error(key, at,
                              "is that of the static position under gravity, and there is none: nothing holds " +
                                  dynamics::describe_softest_motion(system.stiffness, system.dofs) +
                                  "; add a support or a spring there");
  for (const std::size_t i : beams) {
    Element& beam = *model_.elements[i];
    std::vector<double> forces;
    for (Index part = 0; part + 1 < std::ssize(beam.axis()); ++part)
      forces.push_back(axial_force(*beam.cut(part, true), *beam.cut(part, false), system, *x));
    beam.set_preload(std::move(forces));
  }
}

void SceneReader::check_buckling() {
  double largest = 0.0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < model_.elements.size(); ++i)
    for (const double force : model_.elements[i]->preload())
      if (-force > largest) largest = -force, at = i;
  if (largest == 0.0) return;
  const double factor = dynamics::critical_preload_factor(model_, 1.0);
  if (!(factor <= 1.0)) return;
  const std::string what = "buckles the structure: its compression of " + to_short_text(largest) +
                           " N is beyond the critical load of " + to_short_text(factor * largest) + " N";
  const std::string key = element_places_[at].first + ".preload";
  if (model_.stops.empty())
    diagnostics_.error(key, element_places_[at].second, what + "; make it smaller, or hold the beam sideways");
  else
    diagnostics_.warning(key, element_places_[at].second, what + "; only contacts can hold it");
}

}  // namespace butee::scene

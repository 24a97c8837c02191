#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/SparseCholesky>

#include "butee/core/text.hpp"
#include "butee/model/system.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Value;

namespace {

/// The highest frequency of a DOF, rad/s; that of atoms in steel is 1e14. Beyond it results are rounding, or overflow.
constexpr double kFastest = 1e20;
/// The highest rate of decay of a DOF, 1/s, which implicit methods pass over.
constexpr double kFastestDecay = 1e40;
/// A scene is refused if the rounding of a sum is this part of all that holds its DOF.
constexpr double kLost = 1e-2;
/// The part above which there is a warning, and that which the advised stiffness leaves.
constexpr double kWorn = 1e-4, kAdvised = 1e-6;

std::string with_unit(double value, DofKind kind, const char* of_motion, const char* of_rotation) {
  return to_short_text(value) + " " + (is_rotation(kind) ? of_rotation : of_motion);
}

std::string of_stiffness(double value, DofKind kind) {
  return with_unit(value, kind, "N/m", "N m/rad");
}

std::string in_percent(double part) {
  return to_short_text(100.0 * part, 2) + " %";
}

}  // namespace

void SceneReader::check_magnitudes() {
  sums_.emplace(*dofs_);
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    sums_->begin_element(i);
    model_.elements[i]->assemble(*sums_);
  }
  const auto complain = [&](std::size_t element, const std::string& complaint) {
    diagnostics_.error(element_places_[element].first, element_places_[element].second, complaint);
  };
  for (const auto& [element, complaint] : sums_->complaints()) complain(element, complaint);
  std::set<std::size_t> reported;
  for (std::size_t i = 0; i < sums_->sums().size() && sums_->complaints().empty(); ++i) {
    const ElementSums::Sum& sum = sums_->sums()[i];
    const model::NodalDof dof = dofs_->free()[i];
    const std::string place = dofs_->name(dof),
                      beside = " beside " + with_unit(sum.mass, dof.kind, "kg", "kg m2") + " there";
    if (const double rate = std::sqrt(sum.stiffness / sum.mass);
        rate > kFastest && reported.insert(sum.stiffest.element).second)
      complain(sum.stiffest.element, "its stiffness of " + of_stiffness(sum.stiffest.value, dof.kind) + " on " + place +
                                         beside + " oscillates faster than " + to_short_text(kFastest) +
                                         " rad/s, the most that can be computed: check its values, in SI units");
    if (const double rate = sum.damping / sum.mass;
        rate > kFastestDecay && reported.insert(sum.most_damped.element).second)
      complain(sum.most_damped.element, "its damping of " +
                                            with_unit(sum.most_damped.value, dof.kind, "N s/m", "N m s/rad") + " on " +
                                            place + beside + " decays faster than " + to_short_text(kFastestDecay) +
                                            " 1/s, the most that can be computed: check its values, in SI units");
    const double rounded = 0.5 * std::numeric_limits<double>::epsilon() * sum.stiffness;
    if (sum.softest.value > 0.0 && rounded > kWorn * sum.softest.value) rounded_.push_back(static_cast<Index>(i));
  }
  if (diagnostics_.error_count() == 0) check_rounding();
}

double SceneReader::run_time() const {
  const Value* integrator = root_.table()->find("integrator");
  const Value* end =
      integrator != nullptr && integrator->table() != nullptr ? integrator->table()->find("end_time") : nullptr;
  const double given = end != nullptr ? config::as_number(*end).value_or(1.0) : 1.0;
  return given > 0.0 && std::isfinite(given) ? given : 1.0;
}

void SceneReader::check_rounding() {
  if (rounded_.empty()) return;
  constexpr std::size_t kMost = 20;
  const double time = run_time();
  const System system = assemble(model_, TurningParts::apart);
  // Over the run, inertia holds what no spring holds.
  const SparseMatrix held = system.stiffness + (1.0 / (time * time)) * system.mass;
  const Eigen::SimplicialLDLT<SparseMatrix> factor(held);
  if (factor.info() != Eigen::Success) return;
  std::set<std::size_t> reported;
  for (std::size_t k = 0; k < std::min(rounded_.size(), kMost); ++k) {
    const Index i = rounded_[k];
    const ElementSums::Sum& sum = sums_->sums()[static_cast<std::size_t>(i)];
    const double holds = 1.0 / factor.solve(Vector::Unit(system.size(), i).eval())[i];
    const double rounded = 0.5 * std::numeric_limits<double>::epsilon() * sum.stiffness, part = rounded / holds;
    if (!(std::abs(part) > kWorn) || !reported.insert(sum.softest.element).second) continue;
    const model::NodalDof dof = dofs_->free()[static_cast<std::size_t>(i)];
    const std::string place = dofs_->name(dof);
    const auto& [path, at] = element_places_[sum.softest.element];
    const std::string complaint =
        "its stiffness of " + of_stiffness(sum.softest.value, dof.kind) + " on " + place + " is added to " +
        of_stiffness(sum.stiffest.value, dof.kind) + " of " + element_places_[sum.stiffest.element].first +
        ", and double precision rounds the sum by " + of_stiffness(rounded, dof.kind) + ", " +
        (std::abs(part) < 1.0 ? in_percent(std::abs(part)) + " of" : "more than") + " all that holds " + place +
        ": join the nodes or fix them instead, or make the stiffer one at most " +
        of_stiffness(kAdvised / std::abs(part) * sum.stiffest.value, dof.kind);
    if (std::abs(part) > kLost)
      diagnostics_.error(path, at, complaint);
    else
      diagnostics_.warning(path, at, complaint);
  }
}

void SceneReader::check_rate(const config::Parameters& parameters, const std::string& key, double stiffness,
                             const std::vector<NodeId>& nodes, const std::vector<DofKind>& directions) {
  if (!sums_) return;
  for (const NodeId node : nodes)
    for (const DofKind kind : directions) {
      const Index at = dofs_->index({node, kind});
      if (at < 0) continue;
      const double mass = sums_->sums()[static_cast<std::size_t>(at)].mass, rate = std::sqrt(stiffness / mass);
      if (!(rate > kFastest)) continue;
      const std::string complaint = "a closed contact of " + of_stiffness(stiffness, kind) + " on " +
                                    dofs_->name({node, kind}) + " beside " + with_unit(mass, kind, "kg", "kg m2") +
                                    " there oscillates faster than " + to_short_text(kFastest) +
                                    " rad/s, the most that can be computed: check the values, in SI units";
      if (parameters.given(key))
        parameters.complain(diagnostics_, key, complaint);
      else
        diagnostics_.error(parameters.path(), parameters.at(), complaint);
      return;
    }
}

void SceneReader::check_decay(const config::Parameters& parameters) {
  if (!sums_) return;
  double square = 0.0;
  for (const ElementSums::Sum& sum : sums_->sums()) square = std::max(square, sum.stiffness / sum.mass);
  if (model_.damping.stiffness_proportional * square > kFastestDecay)
    parameters.complain(diagnostics_, "stiffness_proportional",
                        "damps motion faster than " + to_short_text(kFastestDecay) +
                            " 1/s, the most that can be computed; it is in seconds, such as 1e-6");
  if (model_.damping.mass_proportional > kFastestDecay)
    parameters.complain(diagnostics_, "mass_proportional",
                        "at most " + to_short_text(kFastestDecay) + " 1/s can be computed; it is in 1/s, such as 1");
}

}  // namespace butee::scene

#include "butee/dynamics/mode_analysis.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_damping.hpp"

namespace butee::dynamics {
namespace {

using model::NodeId;

/// The stops of a model in one direction, elastic or with dissipation, closed.
std::vector<ClosedStop> all_closed(const model::Model& model) {
  std::vector<ClosedStop> stops;
  const auto add = [&stops](const auto& group, DofKind dof) {
    for (std::size_t i = 0; i < group.a.size(); ++i)
      stops.push_back(
          {group.a[i], group.b.empty() ? ClosedStop::kGround : group.b[i], group.law->closed_stiffness(), dof});
  };
  for (const model::StopGroup& group : model.stops) add(group, group.dof);
  for (const model::ObstacleGroup& group : model.obstacles)
    if (group.shape != nullptr && group.directions.size() == 1) add(group, group.directions.front());
  return stops;
}

std::set<NodeId> selected(const model::Model& model, const std::string& selector) {
  const model::Selection selection = model.nodes.select(selector);
  if (!selection.problem.empty()) throw InputError("--closed " + selector + ": " + selection.problem);
  std::set<NodeId> nodes;
  for (const NodeId node : selection.nodes) nodes.insert(model.nodes.canonical(node));
  return nodes;
}

/// phi^T C phi / (2 omega), the damping ratio of each mode alone: dashpots and modal damping of
/// other modes may couple modes.
class Ratios {
 public:
  Ratios(const model::System& system, bool all_open) : system_(system), all_open_(all_open) {
    if (system.damping.is_modal() && !all_open) modal_ = ModalDamping::of(system);
  }

  double of(Index mode, double omega, const Vector& shape) const {
    const model::Damping& damping = system_.damping;
    double c = damping.mass_proportional;
    if (damping.stiffness_proportional != 0.0)
      c += damping.stiffness_proportional * (all_open_ ? omega * omega : shape.dot(system_.stiffness * shape));
    if (system_.dashpots.size() > 0) c += shape.dot(system_.dashpots * shape);
    if (modal_) c += (modal_->factor().transpose() * shape).squaredNorm();
    return c / (2.0 * omega) + (all_open_ ? modal_ratio(mode) : 0.0);
  }

 private:
  double modal_ratio(Index mode) const {
    const model::Damping& damping = system_.damping;
    const auto i = static_cast<std::size_t>(mode);
    return i < damping.lowest_modes.size() ? damping.lowest_modes[i] : damping.every_mode;
  }

  const model::System& system_;
  bool all_open_;
  std::unique_ptr<const ModalDamping> modal_;
};

}  // namespace

std::vector<ClosedStop> closed_stops(const model::Model& model, const std::vector<std::string>& selectors) {
  const std::vector<ClosedStop> all = all_closed(model);
  std::vector<bool> is_chosen(all.size(), false);
  for (const std::string& selector : selectors) {
    const bool every = selector == "all";
    const std::set<NodeId> nodes = every ? std::set<NodeId>{} : selected(model, selector);
    const auto touches = [&](NodeId node) {
      return node != ClosedStop::kGround && nodes.contains(model.nodes.canonical(node));
    };
    bool found = false;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (every || touches(all[i].a) || touches(all[i].b)) is_chosen[i] = found = true;
    if (found) continue;
    if (all.empty()) throw InputError("--closed " + selector + ": the scene has no stops in one direction");
    constexpr std::size_t kShown = 8;
    std::vector<std::string> places;
    for (std::size_t i = 0; i < std::min(all.size(), kShown); ++i) places.push_back(model.nodes.name(all[i].a));
    throw InputError("--closed " + selector + ": no stop in one direction acts there; they act at " + join(places) +
                     (all.size() > kShown ? " and " + std::to_string(all.size() - kShown) + " more" : ""));
  }
  std::vector<ClosedStop> stops;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_chosen[i]) stops.push_back(all[i]);
  return stops;
}

ModeAnalysis analyse_modes(const model::Model& model, const model::System& system,
                           const std::vector<ClosedStop>& closed, Index count) {
  if (count > system.size())
    throw InputError(std::to_string(count) +
                     " modes: the scene has no more modes than free DOFs: " + std::to_string(system.size()));
  const Structure structure(model, system.dofs, closed);
  NaturalModes found = find_modes(structure, count);
  if (!found.problem.empty()) throw RunError("the modes could not be computed: " + found.problem);
  ModeAnalysis analysis;
  analysis.title = model.title;
  analysis.dofs = system.size();
  for (const model::FreeStops& stops : system.stops) analysis.stops += static_cast<Index>(stops.size());
  for (const model::FreeObstacles& obstacles : system.obstacles)
    if (obstacles.group->shape != nullptr && obstacles.group->directions.size() == 1)
      analysis.stops += static_cast<Index>(obstacles.ends.size());
  analysis.closed = static_cast<Index>(closed.size());
  analysis.total_mass = structure.total_mass();
  analysis.dense = found.dense;
  const Ratios ratios(system, closed.empty());
  for (Index i = 0; i < count; ++i) {
    Mode mode;
    mode.omega = found.frequencies[i];
    mode.frequency = mode.omega / (2.0 * std::numbers::pi);
    mode.rigid = mode.omega == 0.0;
    const Vector shape = found.shapes.col(i);
    if (!mode.rigid) mode.damping = ratios.of(i, mode.omega, shape);
    const double participation = shape.dot(structure.carried());
    mode.effective_mass = participation * participation;
    if (structure.total_mass() > 0.0) mode.effective_part = mode.effective_mass / structure.total_mass();
    mode.residual = found.residuals[i];
    mode.rounding = found.rounding[i];
    analysis.modes.push_back(mode);
  }
  analysis.shapes = std::move(found.shapes);
  return analysis;
}

}  // namespace butee::dynamics

#include "butee/dynamics/mode_analysis.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_damping.hpp"

namespace butee::dynamics {
namespace {

using model::NodeId;

/// The indices (group, stop) of all stops that act on a node of `nodes`; of all stops if that is
/// null.
std::set<std::pair<std::size_t, std::size_t>> places_of(const model::Model& model, const std::set<NodeId>* nodes) {
  std::set<std::pair<std::size_t, std::size_t>> places;
  const auto touches = [&](NodeId node) { return nodes->contains(model.nodes.canonical(node)); };
  for (std::size_t g = 0; g < model.stops.size(); ++g) {
    const model::StopGroup& group = model.stops[g];
    for (std::size_t i = 0; i < group.a.size(); ++i)
      if (nodes == nullptr || touches(group.a[i]) || (!group.b.empty() && touches(group.b[i]))) places.emplace(g, i);
  }
  return places;
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
  std::set<std::pair<std::size_t, std::size_t>> places;
  for (const std::string& selector : selectors) {
    const bool all = selector == "all";
    const std::set<NodeId> nodes = all ? std::set<NodeId>{} : selected(model, selector);
    auto found = places_of(model, all ? nullptr : &nodes);
    if (found.empty())
      throw InputError("--closed " + selector + (all ? ": the scene has no stops" : ": no stop acts there"));
    places.merge(found);
  }
  std::vector<ClosedStop> stops;
  for (const auto& [g, i] : places) {
    const model::StopGroup& group = model.stops[g];
    stops.push_back({group.a[i], group.b.empty() ? ClosedStop::kGround : group.b[i], group.law->closed_stiffness()});
  }
  return stops;
}

ModeAnalysis analyse_modes(const model::Model& model, const model::System& system,
                           const std::vector<ClosedStop>& closed, Index count) {
  if (count > system.size())
    throw InputError("-n " + std::to_string(count) +
                     ": the scene has no more modes than free DOFs: " + std::to_string(system.size()));
  const Structure structure(model, system.dofs, closed);
  NaturalModes found = find_modes(structure, count);
  if (!found.problem.empty()) throw RunError("the modes could not be computed: " + found.problem);
  ModeAnalysis analysis;
  analysis.title = model.title;
  analysis.dofs = system.size();
  for (const model::FreeStops& stops : system.stops) analysis.stops += static_cast<Index>(stops.size());
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

#include "butee/record/contacts_on.hpp"

#include <algorithm>
#include <array>

namespace butee::record {
namespace {

/// Calls `visit(number, group, i)` for every assembled contact i of the groups: one with a free DOF along
/// `along(group)`.
template <class Groups, class Along, class Visit>
void for_assembled(const Groups& groups, const model::DofTable& dofs, const Along& along, const Visit& visit) {
  Index number = 0;
  for (const auto& group : groups)
    for (std::size_t i = 0; i < group.a.size(); ++i) {
      const auto& kinds = along(group);
      const bool moves = std::any_of(kinds.begin(), kinds.end(), [&](DofKind kind) {
        return dofs.index({group.a[i], kind}) >= 0 || (!group.b.empty() && dofs.index({group.b[i], kind}) >= 0);
      });
      if (moves) visit(number++, group, i);
    }
}

template <class Visit>
void for_stops(const model::Model& model, const model::DofTable& dofs, const Visit& visit) {
  for_assembled(
      model.stops, dofs, [](const model::StopGroup& group) { return std::array{group.dof}; }, visit);
}

template <class Visit>
void for_obstacles(const model::Model& model, const model::DofTable& dofs, const Visit& visit) {
  const auto along = [](const model::ObstacleGroup& group) {
    std::vector<DofKind> kinds = group.directions;
    if (group.twists()) kinds.push_back(DofKind::rx);
    return kinds;
  };
  for_assembled(model.obstacles, dofs, along, visit);
}

}  // namespace

ContactsOn contacts_on(const model::Model& model, const model::DofTable& dofs, model::NodalDof dof) {
  const model::NodeId wanted = model.nodes.canonical(dof.node);
  const auto is_here = [&](const std::vector<model::NodeId>& side, std::size_t i) {
    return !side.empty() && model.nodes.canonical(side[i]) == wanted;
  };
  ContactsOn found;
  for_stops(model, dofs, [&](Index number, const model::StopGroup& group, std::size_t i) {
    if (group.dof != dof.kind) return;
    if (is_here(group.a, i)) found.stops.push_back({number, 1.0});
    if (is_here(group.b, i)) found.stops.push_back({number, -1.0});
  });
  for_obstacles(model, dofs, [&](Index number, const model::ObstacleGroup& group, std::size_t i) {
    for (std::size_t k = 0; k < group.directions.size(); ++k) {
      if (group.directions[k] != dof.kind) continue;
      if (is_here(group.a, i)) found.obstacles.push_back({number, k, 1.0});
      if (is_here(group.b, i)) found.obstacles.push_back({number, k, -1.0});
    }
    if (dof.kind != DofKind::rx || !group.twists()) return;
    if (is_here(group.a, i)) found.obstacles.push_back({number, ContactsOn::Obstacle::kMoment, group.arm_a});
    if (is_here(group.b, i)) found.obstacles.push_back({number, ContactsOn::Obstacle::kMoment, -group.arm_b});
  });
  return found;
}

std::vector<Index> obstacles_at(const model::Model& model, const model::DofTable& dofs, model::NodeId node) {
  const model::NodeId wanted = model.nodes.canonical(node);
  std::vector<Index> found;
  for_obstacles(model, dofs, [&](Index number, const model::ObstacleGroup& group, std::size_t i) {
    for (const auto* side : {&group.a, &group.b})
      if (!side->empty() && model.nodes.canonical((*side)[i]) == wanted) {
        found.push_back(number);
        return;
      }
  });
  return found;
}

}  // namespace butee::record

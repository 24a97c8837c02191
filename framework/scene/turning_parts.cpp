#include "butee/scene/turning_parts.hpp"

#include <algorithm>
#include <string>

namespace butee::scene {
namespace {

using model::DofTable;
using model::NodeId;

/// The DOFs of the elements that turn with [rotation].
DofTable turning_dofs(const model::Model& model) {
  DofTable turning(model.nodes);
  for (std::size_t i = 0; i < std::min(model.elements.size(), model.turns.size()); ++i)
    if (model.turns[i]) model.elements[i]->claim(turning);
  return turning;
}

bool has_any(const DofTable& dofs, NodeId node) {
  return std::any_of(kAllDofKinds.begin(), kAllDofKinds.end(), [&](DofKind kind) { return dofs.exists({node, kind}); });
}

bool is_along_y_or_z(DofKind kind) {
  return kind == DofKind::uy || kind == DofKind::uz;
}

bool are_some(Index count, const std::vector<NodeId>& of) {
  return count > 0 && count < std::ssize(of);
}

}  // namespace

void TurningParts::set_arms(const model::ContactShape::Form& form, model::ObstacleGroup& group) const {
  if (radius == 0.0) return;
  using Kind = model::ContactShape::Form::Kind;
  const double sign = is_mirrored ? -1.0 : 1.0, r = sign * radius,
               apart = sign * (form.kind == Kind::circle ? form.sense : 1.0) * form.distance;
  const bool second_is_inside = b_turns && !a_turns;
  group.arm_a = second_is_inside ? -(r + apart) : r;
  group.arm_b = second_is_inside ? -r : r + apart;
  group.turning = (a_turns ? group.arm_a : 0.0) - (b_turns ? group.arm_b : 0.0);
}

std::optional<TurningParts> read_turning_parts(const config::Parameters& contact, const model::Model& model,
                                               const DofTable& dofs, const ContactEnds& ends,
                                               config::Diagnostics& diagnostics) {
  const auto complain = [&](const char* key, const std::string& words) {
    contact.complain(diagnostics, key, words);
    return std::nullopt;
  };
  const DofTable turning = turning_dofs(model);
  Index a_turn = 0, b_turn = 0;
  std::string one;
  for (const auto& [nodes, count] : {std::pair(&ends.a, &a_turn), std::pair(&ends.b, &b_turn)})
    for (const NodeId node : *nodes)
      if (has_any(turning, node)) {
        ++*count;
        one = model.nodes.name(node);
      }
  const bool is_about_x = std::all_of(ends.directions.begin(), ends.directions.end(), is_along_y_or_z);
  if (!is_about_x && !one.empty())
    return complain("friction", one +
                                    " turns about x, so that its surface slides across the directions of this contact; "
                                    "friction on turning parts needs contacts along uy and uz");
  if (!contact.has("radius")) {
    if (one.empty()) return TurningParts{};
    return complain("radius", "missing; " + one +
                                  " turns, and friction needs the radius (m) at which it touches, 0 for a part that "
                                  "stands still");
  }
  const double radius = contact.number("radius");
  if (!is_about_x && radius != 0.0)
    return complain("radius", "is the arm of friction about x, which needs contacts along uy and uz; remove it");
  // Masses without a rotation may represent shafts that turn.
  if (a_turn == 0 && b_turn == 0 && model.rotation != nullptr)
    a_turn = std::count_if(ends.a.begin(), ends.a.end(), [&](NodeId node) {
      return !dofs.exists({node, DofKind::rx});
    });
  if (radius != 0.0 && (are_some(a_turn, ends.a) || are_some(b_turn, ends.b)))
    return complain(ends.b.empty() ? "nodes" : "between",
                    "some of these nodes turn and others do not; give them in separate [[contact]] tables");
  return TurningParts{ends.directions.size() == 2 && ends.directions.front() == DofKind::uz, radius, a_turn > 0,
                      b_turn > 0};
}

}  // namespace butee::scene

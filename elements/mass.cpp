#include "elements/mass.hpp"

#include <array>

namespace butee::elements {

using config::Parameters;

Mass::Mass(model::NodeId node, double mass, double rotary_inertia)
    : node_(node), mass_(mass), rotary_inertia_(rotary_inertia) {}

void Mass::claim(model::DofTable& dofs) const {
  if (mass_ > 0.0) dofs.claim({node_, DofKind::uy}, true);
  if (rotary_inertia_ > 0.0) dofs.claim({node_, DofKind::rz}, true);
}

void Mass::claim_shared(model::DofTable& dofs) const {
  for (const DofKind kind : kAllDofKinds)
    if (of(kind) > 0.0 && dofs.exists({node_, kind})) dofs.claim({node_, kind}, true);
}

double Mass::of(DofKind kind) const {
  if (!is_rotation(kind)) return mass_;
  return kind == DofKind::rx ? 0.0 : rotary_inertia_;
}

void Mass::assemble(model::MatrixSink& sink) const {
  for (const DofKind kind : kAllDofKinds) {
    if (of(kind) <= 0.0) continue;
    model::ElementMatrices matrices(1);
    matrices.mass(0, 0) = of(kind);
    sink.add(std::array{model::NodalDof{node_, kind}}, matrices);
  }
}

model::ElementType mass_type() {
  using config::number;
  return {"mass",
          "lumped mass, on a node of its own or on one of a beam",
          {number("mass", "kg", "the mass").at_least(0),
           number("rotary_inertia", "kg m2", "the moment of inertia about y and z").at_least(0).or_else(0.0),
           config::text("node", "the node of the mass; default: one is created with the element's name").optional()},
          [](const Parameters& p, config::Diagnostics& diagnostics) -> model::ElementType::Nodes {
            if (p.number("mass") == 0.0 && p.number("rotary_inertia") == 0.0)
              p.complain(diagnostics, "mass", "must be > 0 (kg) where rotary_inertia is 0; give one of them");
            if (p.has("node")) return std::nullopt;
            return std::vector<double>{};
          },
          [](const Parameters& p, model::ElementContext& context) -> std::unique_ptr<model::Element> {
            const auto node = p.has("node") ? context.node(p, "node") : std::optional(context.own_node());
            if (!node) return nullptr;
            return std::make_unique<Mass>(*node, p.number("mass"), p.number("rotary_inertia"));
          }};
}

}  // namespace butee::elements

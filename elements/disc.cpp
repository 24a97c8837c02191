#include "elements/disc.hpp"

#include <array>

namespace butee::elements {

using config::Parameters;
using model::NodalDof;

Disc::Disc(model::NodeId node, double mass, double diametral_inertia, double polar_inertia)
    : node_(node), mass_(mass), diametral_inertia_(diametral_inertia), polar_inertia_(polar_inertia) {}

double Disc::of(DofKind kind) const {
  if (!is_rotation(kind)) return mass_;
  return kind == DofKind::rx ? polar_inertia_ : diametral_inertia_;
}

void Disc::claim(model::DofTable& dofs) const {
  for (const DofKind kind : {DofKind::uy, DofKind::uz}) dofs.claim({node_, kind}, true);
  for (const DofKind kind : {DofKind::ry, DofKind::rz})
    if (of(kind) > 0.0) dofs.claim({node_, kind}, true);
}

void Disc::claim_shared(model::DofTable& dofs) const {
  for (const DofKind kind : kAllDofKinds)
    if (of(kind) > 0.0 && dofs.exists({node_, kind})) dofs.claim({node_, kind}, true);
}

void Disc::assemble(model::MatrixSink& sink) const {
  for (const DofKind kind : kAllDofKinds) {
    const bool comes_below = kind == DofKind::ry || kind == DofKind::rz;
    if (of(kind) <= 0.0 || comes_below) continue;
    model::ElementMatrices matrices(1);
    matrices.mass(0, 0) = of(kind);
    sink.add(std::array{NodalDof{node_, kind}}, matrices);
  }
  if (diametral_inertia_ <= 0.0) return;
  const std::array tilt = {NodalDof{node_, DofKind::ry}, NodalDof{node_, DofKind::rz}};
  model::ElementMatrices matrices(2);
  matrices.mass.diagonal().setConstant(diametral_inertia_);
  if (sink.turns()) {
    // On the left of the equations of motion in (ry, rz): + I_p Omega rz' about y, - I_p Omega ry' about z.
    matrices.gyroscopic = Eigen::MatrixXd::Zero(2, 2);
    matrices.gyroscopic(0, 1) = polar_inertia_;
    matrices.gyroscopic(1, 0) = -polar_inertia_;
    sink.add(tilt, matrices);
    return;
  }
  model::ElementMatrices alone(1);
  alone.mass(0, 0) = diametral_inertia_;
  for (const NodalDof dof : tilt) sink.add(std::span(&dof, 1), alone);
}

std::string Disc::turning_problem() const {
  return diametral_inertia_ > 0.0 && polar_inertia_ == 0.0
             ? "it has no polar_inertia, without which its gyroscopic moment is not known"
             : "";
}

model::ElementType disc_type() {
  using config::number;
  return {"disc",
          "rigid disc on a shaft along x, gyroscopic where the shaft turns",
          {number("mass", "kg", "the mass").above(0),
           number("diametral_inertia", "kg m2", "the moment of inertia about a diameter").at_least(0).or_else(0.0),
           number("polar_inertia", "kg m2", "the moment of inertia about the axis").at_least(0).or_else(0.0),
           config::text("node", "the node of the disc; default: one is created with the element's name").optional()},
          [](const Parameters& p, config::Diagnostics& diagnostics) -> model::ElementType::Nodes {
            if (p.number("polar_inertia") > 2.0 * p.number("diametral_inertia") * (1.0 + 1e-9) &&
                p.number("diametral_inertia") > 0.0)
              p.complain(diagnostics, "polar_inertia", "is more than twice diametral_inertia, which is impossible");
            if (p.number("polar_inertia") > 0.0 && p.number("diametral_inertia") == 0.0)
              p.complain(diagnostics, "diametral_inertia",
                         "missing; a disc with polar_inertia needs one of at least half of it");
            if (p.has("node")) return std::nullopt;
            return std::vector<double>{};
          },
          [](const Parameters& p, model::ElementContext& context) -> std::unique_ptr<model::Element> {
            const auto node = p.has("node") ? context.node(p, "node") : std::optional(context.own_node());
            if (!node) return nullptr;
            return std::make_unique<Disc>(*node, p.number("mass"), p.number("diametral_inertia"),
                                          p.number("polar_inertia"));
          }};
}

}  // namespace butee::elements

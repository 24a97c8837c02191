#include "elements/spring.hpp"

#include <array>

namespace butee::elements {

using config::Parameters;
using model::NodalDof;
using model::NodeId;

namespace {

std::unique_ptr<model::Element> make_spring(const Parameters& p, model::ElementContext& context) {
  const DofKind kind = *dof_named(p.text("dof"));
  if (p.flag("rotating") && axis_of(kind) == 0) {
    p.complain(context.diagnostics(), "rotating", "applies to a dashpot across the shaft, not along or about it");
    return nullptr;
  }
  std::vector<NodeId> a, b;
  if (p.has("node")) {
    const auto node = context.node(p, "node");
    if (!node) return nullptr;
    a = {*node};
  } else {
    const auto ends = context.nodes(p, "nodes");
    if (!ends) return nullptr;
    const std::vector<std::string> names = p.texts("nodes");
    if (names.size() == 2) {
      a = context.select(names[0]).nodes;
      b = context.select(names[1]).nodes;
    }
    if (a.empty() || a.size() != b.size()) {
      p.complain(context.diagnostics(), "nodes",
                 "must name two nodes, such as [\"rotor:4\", \"casing:4\"], or two ranges of equal length");
      return nullptr;
    }
  }
  return std::make_unique<Spring>(std::move(a), std::move(b), kind, p.number("stiffness"), p.number("damping"),
                                  p.flag("rotating"));
}

}  // namespace

Spring::Spring(std::vector<NodeId> a, std::vector<NodeId> b, DofKind kind, double stiffness, double damping,
               bool rotating)
    : a_(std::move(a)), b_(std::move(b)), kind_(kind), stiffness_(stiffness), damping_(damping), rotating_(rotating) {}

void Spring::claim(model::DofTable& dofs) const {
  for (const NodeId node : a_) dofs.claim({node, kind_}, false);
  for (const NodeId node : b_) dofs.claim({node, kind_}, false);
}

void Spring::assemble_rotating(model::MatrixSink& sink) const {
  // Next to each DOF: the other DOF of its plane of rotation, since rotating damping also depends
  // on its displacement.
  const DofKind other = (is_rotation(kind_) ? rotation_about : displacement_along)(3 - axis_of(kind_));
  for (std::size_t i = 0; i < a_.size(); ++i) {
    std::vector<NodalDof> dofs = {{a_[i], kind_}, {a_[i], other}};
    if (!b_.empty()) dofs.insert(dofs.end(), {{b_[i], kind_}, {b_[i], other}});
    model::ElementMatrices matrices(std::ssize(dofs));
    for (std::size_t row = 0; row < dofs.size(); row += 2)
      for (std::size_t column = 0; column < dofs.size(); column += 2)
        matrices.stiffness(static_cast<Index>(row), static_cast<Index>(column)) = row == column ? 1.0 : -1.0;
    matrices.rotating_damping = damping_ * matrices.stiffness;
    matrices.stiffness *= stiffness_;
    sink.add(dofs, matrices);
  }
}

void Spring::assemble(model::MatrixSink& sink) const {
  if (rotating_ && sink.turns()) return assemble_rotating(sink);
  const bool grounded = b_.empty();
  model::ElementMatrices matrices(grounded ? 1 : 2);
  if (grounded)
    matrices.stiffness << 1.0;
  else
    matrices.stiffness << 1.0, -1.0, -1.0, 1.0;
  matrices.damping = damping_ * matrices.stiffness;
  matrices.stiffness *= stiffness_;
  for (std::size_t i = 0; i < a_.size(); ++i) {
    if (grounded)
      sink.add(std::array{NodalDof{a_[i], kind_}}, matrices);
    else
      sink.add(std::array{NodalDof{a_[i], kind_}, NodalDof{b_[i], kind_}}, matrices);
  }
}

model::ElementType spring_type() {
  using config::number, config::text;
  return {"spring",
          "spring and parallel dashpot, to ground (node) or between two nodes (nodes)",
          {text("node", "the node of a spring to ground").optional(),
           config::texts("nodes", "the two nodes, or two equally long ranges joined pair by pair").optional(),
           text("dof", "the degree of freedom").one_of(model::dof_names()).or_else("u"),
           number("stiffness", "N/m", "the stiffness (N m/rad on a rotation)").at_least(0),
           number("damping", "N s/m", "the dashpot (N m s/rad on a rotation)").at_least(0).or_else(0.0),
           config::boolean("rotating", "the dashpot turns with the shaft: give one spring each for uy and uz")
               .or_else(false)},
          [](const Parameters& p, config::Diagnostics& diagnostics) -> model::ElementType::Nodes {
            if (p.has("node") == p.has("nodes"))
              p.complain(diagnostics, p.has("node") ? "nodes" : "node",
                         p.has("node") ? "conflicts with node; give one of them"
                                       : "missing; give node (to ground) or nodes (between two)");
            return std::nullopt;
          },
          make_spring};
}

}  // namespace butee::elements

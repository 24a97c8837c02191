#include "elements/bearing.hpp"

namespace butee::elements {

using config::Parameters;
using model::NodalDof;
using model::NodeId;

Bearing::Bearing(NodeId a, std::optional<NodeId> b, Eigen::Matrix2d stiffness, Eigen::Matrix2d damping, bool rotating)
    : a_(a), b_(b), stiffness_(std::move(stiffness)), damping_(std::move(damping)), rotating_(rotating) {}

void Bearing::claim(model::DofTable& dofs) const {
  for (const DofKind kind : {DofKind::uy, DofKind::uz}) {
    dofs.claim({a_, kind}, false);
    if (b_) dofs.claim({*b_, kind}, false);
  }
}

void Bearing::assemble(model::MatrixSink& sink) const {
  std::vector<NodalDof> dofs = {{a_, DofKind::uy}, {a_, DofKind::uz}};
  if (b_) dofs.insert(dofs.end(), {{*b_, DofKind::uy}, {*b_, DofKind::uz}});
  const auto spread = [&](const Eigen::Matrix2d& of) {
    Eigen::MatrixXd matrix(dofs.size(), dofs.size());
    if (b_)
      matrix << of, -of, -of, of;
    else
      matrix = of;
    return matrix;
  };
  model::ElementMatrices matrices(std::ssize(dofs));
  matrices.stiffness = spread(stiffness_);
  (rotating_ && sink.turns() ? matrices.rotating_damping : matrices.damping) = spread(damping_);
  sink.add(dofs, matrices);
}

namespace {

Eigen::Matrix2d read_matrix(const Parameters& p, const char* key) {
  return p.has(key) ? Eigen::Matrix2d(p.matrix(key)) : Eigen::Matrix2d::Zero();
}

std::unique_ptr<model::Element> make_bearing(const Parameters& p, model::ElementContext& context) {
  const Eigen::Matrix2d damping = read_matrix(p, "damping");
  const bool rotating = p.flag("rotating");
  if (rotating && (damping(0, 0) != damping(1, 1) || damping(0, 1) != 0.0 || damping(1, 0) != 0.0)) {
    p.complain(context.diagnostics(), "damping", "that rotates must be the same in both directions: [[c, 0], [0, c]]");
    return nullptr;
  }
  std::vector<NodeId> ends;
  if (p.has("node")) {
    const auto node = context.node(p, "node");
    if (!node) return nullptr;
    ends = {*node};
  } else {
    const auto nodes = context.nodes(p, "nodes");
    if (!nodes) return nullptr;
    if (nodes->size() != 2) {
      p.complain(context.diagnostics(), "nodes", "must name two nodes, such as [\"shaft:0\", \"casing:0\"]");
      return nullptr;
    }
    ends = *nodes;
  }
  return std::make_unique<Bearing>(ends.front(), ends.size() > 1 ? std::optional(ends.back()) : std::nullopt,
                                   read_matrix(p, "stiffness"), damping, rotating);
}

}  // namespace

model::ElementType bearing_type() {
  using config::matrix, config::text;
  return {"bearing",
          "stiffness and damping in (uy, uz) with cross terms, to ground (node) or between two nodes (nodes)",
          {text("node", "the node of a bearing to ground").optional(),
           config::texts("nodes", "the two nodes that it joins").optional(),
           matrix("stiffness", "N/m", "[[kyy, kyz], [kzy, kzz]]", 2, 2),
           matrix("damping", "N s/m", "[[cyy, cyz], [czy, czz]]", 2, 2).optional(),
           config::boolean("rotating", "the damping turns with the shaft: internal damping").or_else(false)},
          [](const Parameters& p, config::Diagnostics& diagnostics) -> model::ElementType::Nodes {
            if (p.has("node") == p.has("nodes"))
              p.complain(diagnostics, p.has("node") ? "nodes" : "node",
                         p.has("node") ? "conflicts with node; give one of them"
                                       : "missing; give node (to ground) or nodes (between two)");
            return std::nullopt;
          },
          make_bearing};
}

}  // namespace butee::elements

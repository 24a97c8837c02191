#include "butee/model/base_motion.hpp"

#include <algorithm>
#include <cmath>

#include "butee/model/model.hpp"
#include "butee/model/turning_matrices.hpp"

namespace butee::model {
namespace {

/// Sums of forces that cancel to this fraction of their terms are rounding.
constexpr double kRounding = 1e-13;

bool holds(const NodeTable& nodes, const std::vector<NodeId>& list, NodeId node) {
  return std::any_of(list.begin(), list.end(),
                     [&](NodeId one) { return nodes.canonical(one) == nodes.canonical(node); });
}

/// Sums A_e s over the elements on the free DOFs.
class Sum final : public MatrixSink {
 public:
  Sum(const Model& model, const DofTable& dofs, const Eigen::Vector3d& direction, const std::vector<NodeId>& nodes)
      : model_(model), dofs_(dofs), direction_(direction), moves_(static_cast<std::size_t>(model.nodes.size())) {
    for (const NodeId node : nodes) moves_[static_cast<std::size_t>(model.nodes.canonical(node))] = true;
    moves_all_ = nodes.empty();
    for (std::vector<Term>& terms : terms_) terms.resize(static_cast<std::size_t>(dofs.free_count()));
  }

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    const Damping& damping = model_.damping;
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const double s = prescribed(dofs[j]);
      if (s == 0.0) continue;
      const bool is_free = dofs_.index(dofs[j]) >= 0, is_mass_alone = moves_all_ && !is_free;
      for (std::size_t i = 0; i < dofs.size(); ++i) {
        const Index row = dofs_.index(dofs[i]);
        if (row < 0) continue;
        const auto p = static_cast<Index>(i), q = static_cast<Index>(j);
        const double m = matrices.mass(p, q), k = matrices.stiffness(p, q);
        if (!is_free) take(0, row, m * s);
        if (is_mass_alone) continue;
        take(1, row, (matrices.damping(p, q) + damping.mass_proportional * m + damping.stiffness_proportional * k) * s);
        take(2, row, k * s);
      }
    }
  }

  std::vector<NodalValue> forces(std::size_t order) const {
    std::vector<NodalValue> all;
    for (std::size_t i = 0; i < terms_[order].size(); ++i) {
      const Term& term = terms_[order][i];
      if (std::abs(term.sum) > kRounding * term.size) all.push_back({dofs_.free()[i], term.sum});
    }
    return all;
  }

 private:
  struct Term {
    double sum = 0.0, size = 0.0;
  };

  double prescribed(NodalDof dof) const {
    if (is_rotation(dof.kind)) return 0.0;
    const bool moves =
        moves_all_ || (moves_[static_cast<std::size_t>(model_.nodes.canonical(dof.node))] && dofs_.is_fixed(dof));
    return moves ? direction_[axis_of(dof.kind)] : 0.0;
  }
  void take(std::size_t order, Index row, double value) {
    Term& term = terms_[order][static_cast<std::size_t>(row)];
    term.sum += value;
    term.size += std::abs(value);
  }

  const Model& model_;
  const DofTable& dofs_;
  Eigen::Vector3d direction_;
  std::vector<bool> moves_;
  bool moves_all_ = false;
  std::array<std::vector<Term>, 3> terms_;
};

/// Looks for terms that depend on the speed of rotation in the columns of moved displacements.
class TurningSupports final : public MatrixSink {
 public:
  TurningSupports(const Model& model, const DofTable& dofs) : model_(model), dofs_(dofs) {}

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    const Eigen::MatrixXd damping = rotating_damping_of(matrices, model_.rotating_damping);
    const Eigen::MatrixXd circulatory = circulatory_of(dofs, damping);
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const auto column = static_cast<Index>(j);
      const bool has_terms = !damping.col(column).isZero(0.0) || !circulatory.col(column).isZero(0.0) ||
                             (matrices.gyroscopic.size() > 0 && !matrices.gyroscopic.col(column).isZero(0.0));
      if (has_terms && moves_with_base(model_, dofs_, dofs[j])) found = dofs[j].node;
    }
  }
  bool turns() const override { return true; }

  std::optional<NodeId> found;

 private:
  const Model& model_;
  const DofTable& dofs_;
};

}  // namespace

bool moves_with_base(const Model& model, const DofTable& dofs, NodalDof dof) {
  return dofs.exists(dof) && dofs.is_fixed(dof) && !is_rotation(dof.kind) &&
         std::any_of(model.bases.begin(), model.bases.end(), [&](const BaseMotion& base) {
           return base.direction[axis_of(dof.kind)] != 0.0 &&
                  (base.nodes.empty() || holds(model.nodes, base.nodes, dof.node));
         });
}

std::optional<NodeId> turning_support(const Model& model, const DofTable& dofs) {
  TurningSupports supports(model, dofs);
  for (std::size_t i = 0; i < model.turns.size(); ++i)
    if (model.turns[i]) model.elements[i]->assemble(supports);
  return supports.found;
}

std::vector<BaseShare> base_shares(const Model& model, const DofTable& dofs, NodalDof dof, int order, bool absolute) {
  std::vector<BaseShare> shares;
  if (is_rotation(dof.kind)) return shares;
  const bool is_free = dofs.index(dof) >= 0, is_fixed = dofs.index(dof) == DofTable::kFixed;
  for (const BaseMotion& base : model.bases) {
    const double along = base.direction[axis_of(dof.kind)];
    if (along == 0.0 || !base.motion || (!is_free && !is_fixed)) continue;
    double factor = 0.0;
    if (!base.nodes.empty())
      factor = is_fixed && holds(model.nodes, base.nodes, dof.node) ? along : 0.0;
    else if (model.base_frame == BaseFrame::moving)
      factor = absolute ? along : 0.0;
    else if (is_free)
      factor = absolute ? 0.0 : -along;
    else
      factor = absolute ? along : 0.0;
    if (factor != 0.0) shares.push_back({&(*base.motion)[static_cast<std::size_t>(order)], factor});
  }
  return shares;
}

bool moves_apart(const std::vector<BaseMotion>& bases) {
  return std::any_of(bases.begin(), bases.end(), [](const BaseMotion& base) { return !base.nodes.empty(); });
}

Vector motion_with_base(const Model& model, const DofTable& dofs, int order, double t) {
  Vector motion = Vector::Zero(dofs.free_count());
  if (model.bases.empty() || model.base_frame != BaseFrame::still) return motion;
  for (Index i = 0; i < motion.size(); ++i)
    for (const BaseShare& share : base_shares(model, dofs, dofs.free()[static_cast<std::size_t>(i)], order, false))
      motion[i] -= share.factor * share.motion->value(t);
  return motion;
}

bool knows_base_motion(const Model& model) {
  return std::all_of(model.bases.begin(), model.bases.end(),
                     [](const BaseMotion& base) { return base.motion.has_value(); });
}

PrescribedForces prescribed_forces(const Model& model, const DofTable& dofs, const Eigen::Vector3d& direction,
                                   const std::vector<NodeId>& nodes) {
  Sum sum(model, dofs, direction, nodes);
  for (const auto& element : model.elements) element->assemble(sum);
  return {sum.forces(0), sum.forces(1), sum.forces(2)};
}

}  // namespace butee::model

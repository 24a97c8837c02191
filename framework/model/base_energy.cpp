#include "butee/model/base_energy.hpp"

#include <algorithm>

namespace butee::model {

/// Adds the forms of the elements.
class BaseEnergy::Sum final : public MatrixSink {
 public:
  Sum(BaseEnergy& to, const System& system) : to_(to), model_(*system.model), dofs_(system.dofs) {
    for (Form* form : {&to_.mass_, &to_.damping_, &to_.stiffness_}) {
      form->of_free.setZero(dofs_.free_count(), count());
      form->among.setZero(count(), count());
    }
  }

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    const Damping& damping = model_.damping;
    Eigen::MatrixXd moved(std::ssize(dofs), count()), strained = moved;
    for (Index i = 0; i < moved.rows(); ++i)
      for (Index b = 0; b < count(); ++b) {
        moved(i, b) = of_supports(b, dofs[static_cast<std::size_t>(i)]);
        strained(i, b) = relative_to(b, dofs[static_cast<std::size_t>(i)]);
      }
    if (moved.isZero(0.0) && strained.isZero(0.0)) return;
    add(dofs, matrices.mass, moved, to_.mass_);
    add(dofs, matrices.stiffness, strained, to_.stiffness_);
    add(dofs,
        matrices.damping + damping.mass_proportional * matrices.mass +
            damping.stiffness_proportional * matrices.stiffness,
        strained, to_.damping_);
  }

 private:
  Index count() const { return std::ssize(to_.motions_); }
  const BaseMotion& motion(Index b) const { return *to_.motions_[static_cast<std::size_t>(b)]; }

  /// The displacement of a fixed degree of freedom per unit of a base motion.
  double of_supports(Index b, NodalDof dof) const {
    if (is_rotation(dof.kind) || dofs_.index(dof) >= 0) return 0.0;
    const std::vector<NodeId>& nodes = motion(b).nodes;
    const bool moves = nodes.empty() || std::any_of(nodes.begin(), nodes.end(), [&](NodeId one) {
                         return model_.nodes.canonical(one) == model_.nodes.canonical(dof.node);
                       });
    return moves ? motion(b).direction[axis_of(dof.kind)] : 0.0;
  }

  /// The displacement per unit of a base motion that strains springs and dashpots.
  double relative_to(Index b, NodalDof dof) const {
    if (!motion(b).nodes.empty()) return of_supports(b, dof);
    return is_rotation(dof.kind) || dofs_.index(dof) < 0 ? 0.0 : -motion(b).direction[axis_of(dof.kind)];
  }

  void add(std::span<const NodalDof> dofs, const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& s, Form& to) const {
    const Eigen::MatrixXd forces = 0.5 * (matrix + matrix.transpose()) * s;
    to.among += s.transpose() * forces;
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const Index row = dofs_.index(dofs[i]); row >= 0) to.of_free.row(row) += forces.row(static_cast<Index>(i));
  }

  BaseEnergy& to_;
  const Model& model_;
  const DofTable& dofs_;
};

BaseEnergy::BaseEnergy(const System& system) {
  if (system.model == nullptr || system.model->base_frame != BaseFrame::still) return;
  for (const BaseMotion& base : system.model->bases)
    if (base.motion) motions_.push_back(&base);
  if (motions_.empty()) return;
  Sum sum(*this, system);
  for (const auto& element : system.model->elements) element->assemble(sum);
}

double BaseEnergy::Form::value(ConstVectorRef z, ConstVectorRef d) const {
  return z.dot(of_free * d) + 0.5 * d.dot(among * d);
}

BaseEnergy::Parts BaseEnergy::at(double t, ConstVectorRef x, ConstVectorRef v) const {
  if (is_empty()) return {};
  Vector d(std::ssize(motions_)), speed = d;
  for (Index b = 0; b < d.size(); ++b) {
    const auto& motion = *motions_[static_cast<std::size_t>(b)]->motion;
    d[b] = motion[0].value(t);
    speed[b] = motion[1].value(t);
  }
  return {mass_.value(v, speed), stiffness_.value(x, d), 2.0 * damping_.value(v, speed)};
}

}  // namespace butee::model

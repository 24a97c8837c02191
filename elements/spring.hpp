#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// Springs with parallel dashpots, to ground or between pairs of nodes, on one kind of DOF.
///
///     F_a = -k (x_a - x_b) - c (v_a - v_b),   F_b = -F_a
///
/// A rotating dashpot acts on the velocity relative to the turning shaft, v_y + Omega u_z or v_z -
/// Omega u_y (likewise for rotations); each of the two directions has one.
class Spring final : public model::Element {
 public:
  /// `b` is empty (to ground) or as long as `a`. Stiffness N/m and damping N s/m, or N m/rad and N m s/rad on theta.
  Spring(std::vector<model::NodeId> a, std::vector<model::NodeId> b, DofKind kind, double stiffness, double damping,
         bool rotating = false);

  void claim(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;
  bool is_spring() const override { return true; }
  Turning turning() const override { return rotating_ ? Turning::always : Turning::never; }

 private:
  void assemble_rotating(model::MatrixSink& sink) const;

  std::vector<model::NodeId> a_, b_;
  DofKind kind_;
  double stiffness_, damping_;
  bool rotating_;
};

model::ElementType spring_type();

}  // namespace butee::elements

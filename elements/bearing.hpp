#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// A bearing on (uy, uz), to ground or between two nodes, with full 2 x 2 matrices of stiffness (N/m) and damping
/// (N s/m), not symmetric in general:
///
///     F_a = -K (u_a - u_b) - C (v_a - v_b),   F_b = -F_a
///
/// Rotating damping acts on the velocity relative to the turning shaft and must be isotropic.
class Bearing final : public model::Element {
 public:
  Bearing(model::NodeId a, std::optional<model::NodeId> b, Eigen::Matrix2d stiffness, Eigen::Matrix2d damping,
          bool rotating);

  void claim(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;
  bool is_spring() const override { return true; }
  Turning turning() const override { return rotating_ ? Turning::always : Turning::never; }

 private:
  model::NodeId a_;
  std::optional<model::NodeId> b_;
  Eigen::Matrix2d stiffness_, damping_;
  bool rotating_;
};

model::ElementType bearing_type();

}  // namespace butee::elements

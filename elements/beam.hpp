#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// A planar Euler-Bernoulli beam of two-node elements with Hermite cubics and consistent mass, DOFs (u, theta) a node.
///
/// With l the length, EI the bending stiffness and rho A the mass per length of an element, DOFs (u1, theta1, u2,
/// theta2):
///
///     K_e = E I / l^3 [12 6l -12 6l; . 4l^2 -6l 2l^2; . . 12 -6l; sym 4l^2]
///     M_e = rho A l / 420 [156 22l 54 -13l; . 4l^2 13l -3l^2; . . 156 -22l; sym 4l^2]
///
/// Frequencies are too high by O(l^4). Shear and rotary inertia of the section are left out. Checked against closed
/// forms in tests/unit/beam_test.cpp. Source: J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968,
/// sections 5.6, 11.4.
class Beam final : public model::Element {
 public:
  /// `nodes` along the beam at ascending `coordinates`, m.
  Beam(model::Material material, model::Section section, std::vector<model::NodeId> nodes,
       std::vector<double> coordinates);

  void claim(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;
  bool add_line_load(std::vector<model::NodalValue>& loads) const override;
  std::vector<model::NodeId> axis() const override { return nodes_; }
  /// V = p_u and M = p_theta at the end of a part, their opposites at its beginning.
  std::optional<model::SectionCut> cut(Index part, bool at_end) const override;

 private:
  double length_of(Index part) const;

  model::Material material_;
  model::Section section_;
  std::vector<model::NodeId> nodes_;
  std::vector<double> coordinates_;
};

/// Mass and stiffness of one element of length l.
model::ElementMatrices beam_matrices(const model::Material& material, const model::Section& section, double l);

model::ElementType beam_type();

}  // namespace butee::elements

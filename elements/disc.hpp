#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// A rigid disc on a shaft along x: mass m (kg) in uy, uz and, if another element uses it, ux;
/// diametral inertia I_d in ry and rz, polar inertia I_p in rx (kg m2). When it turns at Omega,
/// with theta = rz and psi = -ry,
///
///     I_d theta'' + I_p Omega psi' = M_theta,    I_d psi'' - I_p Omega theta' = M_psi
///
/// Checked in tests/verification/rotor_test.cpp. Source: M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees,
/// Dynamics of Rotating Machines, 2010, section 5.5.
class Disc final : public model::Element {
 public:
  Disc(model::NodeId node, double mass, double diametral_inertia, double polar_inertia);

  void claim(model::DofTable& dofs) const override;
  void claim_shared(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;
  Turning turning() const override { return Turning::possible; }
  std::string turning_problem() const override;

 private:
  double of(DofKind kind) const;

  model::NodeId node_;
  double mass_, diametral_inertia_, polar_inertia_;
};

model::ElementType disc_type();

}  // namespace butee::elements

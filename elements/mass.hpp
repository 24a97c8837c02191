#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// A lumped mass (kg) at one node, in uy and in every other translation that other parts of the
/// scene use, with rotary inertia (kg m2) in rz and, if used, ry. A zero value claims no DOF.
class Mass final : public model::Element {
 public:
  Mass(model::NodeId node, double mass, double rotary_inertia);

  void claim(model::DofTable& dofs) const override;
  void claim_shared(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;

 private:
  double of(DofKind kind) const;

  model::NodeId node_;
  double mass_, rotary_inertia_;
};

model::ElementType mass_type();

}  // namespace butee::elements

#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// A lumped mass (kg) with rotary inertia (kg m2) at one node. A zero claims no DOF.
class Mass final : public model::Element {
 public:
  Mass(model::NodeId node, double mass, double rotary_inertia);

  void claim(model::DofTable& dofs) const override;
  void assemble(model::MatrixSink& sink) const override;

 private:
  model::NodeId node_;
  double mass_, rotary_inertia_;
};

model::ElementType mass_type();

}  // namespace butee::elements

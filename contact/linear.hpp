#pragma once

#include "butee/model/contact_law.hpp"

namespace butee::contact {

/// The exact unilateral spring: F = k_c max(g, 0).
class Linear final : public model::BatchedLaw<Linear> {
 public:
  /// `stiffness` k_c in N/m.
  explicit Linear(double stiffness) : stiffness_(stiffness) {}

  double secant(double g) const override { return g > 0.0 ? stiffness_ : 0.0; }
  double tangent(double g) const override { return g > 0.0 ? stiffness_ : 0.0; }
  double energy(double g) const override { return g > 0.0 ? 0.5 * stiffness_ * g * g : 0.0; }
  double closed_stiffness() const override { return stiffness_; }
  bool is_piecewise_linear() const override { return true; }
  double transition_width() const override { return 0.0; }

 private:
  double stiffness_;
};

}  // namespace butee::contact

#pragma once

#include <cmath>

#include "butee/model/contact_law.hpp"

namespace butee::contact {

/// Hertz's law, F = k max(g, 0)^n with n >= 1: n = 3/2 for bodies that touch at a point. Checked
/// against the closed form of an impact in tests/verification/impact_damping_test.cpp.
class Hertz final : public model::BatchedLaw<Hertz> {
 public:
  /// `stiffness` in N/m^n.
  Hertz(double stiffness, double exponent) : stiffness_(stiffness), exponent_(exponent) {}

  double secant(double g) const override { return g > 0.0 ? stiffness_ * std::pow(g, exponent_ - 1.0) : 0.0; }
  double tangent(double g) const override { return exponent_ * secant(g); }
  double energy(double g) const override {
    return g > 0.0 ? stiffness_ * std::pow(g, exponent_ + 1.0) / (exponent_ + 1.0) : 0.0;
  }
  /// The tangent at the penetration kTypical, since the stiffness has no upper bound.
  double closed_stiffness() const override { return tangent(kTypical); }

 private:
  static constexpr double kTypical = 1e-5;  // m

  double stiffness_, exponent_;
};

}  // namespace butee::contact

#pragma once

#include "butee/model/contact_law.hpp"

namespace butee::plugins {

/// A contact law of compact support: no force while open, linear for penetrations above `width`,
/// with a continuous second derivative in between.
///
///     s = g/width:   F = 0 (s <= 0),   k_c width (s^3 - s^4/2) (0 <= s <= 1),   k_c (g - width/2) (s >= 1)
///
/// The tangent is k_c times the smoothstep 3 s^2 - 2 s^3. The force has no residual part and no
/// jump, so that equilibrium at rest is well-posed. Checked by differences in
/// tests/plugins/smooth_law_test.cpp.
class Smooth final : public model::BatchedLaw<Smooth> {
 public:
  /// `stiffness` k_c in N/m, `width` in m, both positive.
  Smooth(double stiffness, double width) : stiffness_(stiffness), width_(width) {}

  double secant(double g) const override {
    if (g <= 0.0) return 0.0;
    if (g >= width_) return stiffness_ * (1.0 - 0.5 * width_ / g);
    const double s = g / width_;
    return stiffness_ * s * s * (1.0 - 0.5 * s);
  }
  double tangent(double g) const override {
    if (g <= 0.0) return 0.0;
    if (g >= width_) return stiffness_;
    const double s = g / width_;
    return stiffness_ * s * s * (3.0 - 2.0 * s);
  }
  double energy(double g) const override {
    if (g <= 0.0) return 0.0;
    const double s = g / width_, unit = stiffness_ * width_ * width_;
    if (g >= width_) return unit * (0.5 * s * s - 0.5 * s + 0.15);
    return unit * s * s * s * s * (0.25 - 0.1 * s);
  }
  double closed_stiffness() const override { return stiffness_; }
  double transition_width() const override { return width_; }

 private:
  double stiffness_, width_;
};

}  // namespace butee::plugins

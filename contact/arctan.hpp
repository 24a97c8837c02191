#pragma once

#include <cmath>
#include <numbers>

#include "butee/model/contact_law.hpp"

namespace butee::contact {

/// The paper's regularised stop: F = K_c(g) g with K_c = k_c/2 [2/pi atan(pi lambda g) + 1].
///
/// With x = pi lambda g. For an open stop (x < 0) the bracket is written 2/pi atan(1/|x|), which
/// loses no digits, and beyond |x| = kFar by its series in 1/|x|, exact to rounding, without a
/// transcendental function. The law keeps a residual force of
/// k_c/(pi^2 lambda) towards the stop at any distance. Checked by differences over 1e-9 ... 1 m in
/// tests/unit/contact_law_test.cpp.
class Arctan final : public model::ContactLaw {
 public:
  /// `stiffness` k_c in N/m, `regularization` lambda in 1/m.
  Arctan(double stiffness, double regularization) : stiffness_(stiffness), slope_(std::numbers::pi * regularization) {}

  /// K_c(g)
  double secant(double g) const override {
    const double x = slope_ * g;
    return x < 0.0 ? stiffness_ * open_fraction(-x) : stiffness_ * (1.0 - open_fraction(x));
  }

  /// d(K_c g)/dg = K_c + k_c lambda g / (1 + x^2)
  double tangent(double g) const override {
    const double x = slope_ * g;
    if (x < 0.0) return stiffness_ * open_tangent_fraction(-x);
    return stiffness_ * (1.0 - open_tangent_fraction(x));
  }

  /// V(g) = k_c [g^2/4 + (1/pi)(g^2/2 atan x - g/(2 s) + atan(x)/(2 s^2))], s = pi lambda
  double energy(double g) const override {
    const double s = slope_, x = s * g;
    const double open = open_energy(std::abs(x)) / (s * s);
    return x < 0.0 ? stiffness_ * open : stiffness_ * (0.5 * g * g - open);
  }

  /// Stops far from the transition first, in one vectorised pass; then those within it, one by one.
  void secants(std::span<const double> g, std::span<double> secant) const override;
  void tangents(std::span<const double> g, std::span<double> secant, std::span<double> tangent) const override;

  double closed_stiffness() const override { return stiffness_; }
  std::unique_ptr<model::ForceSeries> force_series() const override;
  double transition_width() const override { return 1.0 / slope_; }
  double asymptotic_force() const override { return stiffness_ / (std::numbers::pi * slope_); }

 private:
  /// Beyond this |x| the series below are exact to rounding: their first omitted terms are 1/(13
  /// x^12) and 7/(15 x^12).
  static constexpr double kFar = 20.0;

  /// atan(1/y)/pi for y > kFar.
  static double far_fraction(double y) {
    const double r = 1.0 / y, q = r * r;
    return r * (1.0 - q * (1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7 - q * (1.0 / 9 - q * (1.0 / 11)))))) *
           std::numbers::inv_pi;
  }
  /// [atan(1/y) - y/(1 + y^2)]/pi for y > kFar.
  static double far_tangent_fraction(double y) {
    const double r = 1.0 / y, q = r * r;
    return 2.0 * r * q * (1.0 / 3 - q * (2.0 / 5 - q * (3.0 / 7 - q * (4.0 / 9 - q * (5.0 / 11 - q * (6.0 / 13)))))) *
           std::numbers::inv_pi;
  }

  /// atan(1/y)/pi for y >= 0: the fraction of k_c that an open stop keeps at x = -y.
  static double open_fraction(double y) {
    if (y > kFar) return far_fraction(y);
    return y > 0.0 ? std::atan(1.0 / y) * std::numbers::inv_pi : 0.5;
  }
  /// The corresponding fraction for the tangent.
  static double open_tangent_fraction(double y) {
    if (y > kFar) return far_tangent_fraction(y);
    return open_fraction(y) - y / (1.0 + y * y) * std::numbers::inv_pi;
  }

  /// s^2 V/k_c at x = -y, V(0) = 0: [y^2 atan(1/y) + y - atan(y)]/(2 pi).
  static double open_energy(double y) {
    return 0.5 * (y * y * open_fraction(y) + (y - std::atan(y)) * std::numbers::inv_pi);
  }

  double stiffness_;
  double slope_;  ///< s = pi lambda, 1/m
};

}  // namespace butee::contact

#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "plain.hpp"

namespace plain {

/// All stops of a problem, evaluated together.
class Contact {
 public:
  explicit Contact(const Problem& problem)
      : force(problem.stops.size()),
        stiffness(problem.stops.size()),
        offset(problem.stops.size()),
        p_(problem),
        g_(problem.stops.size()),
        s_(problem.stops.size()) {}

  /// F_c(u) = -sign(u) K_c(u) g into `force`.
  void evaluate_force(const Vector<double>& x) {
    evaluate(x, [this](std::size_t i, double secant, double) { force[i] = -s_[i] * secant * g_[i]; });
  }

  /// F_c(u) into `force` and -dF_c/du into `stiffness`.
  void evaluate_tangent(const Vector<double>& x) {
    evaluate(x, [this](std::size_t i, double secant, double tangent) {
      force[i] = -s_[i] * secant * g_[i];
      stiffness[i] = tangent;
    });
  }

  /// K_c(u) into `stiffness` and K_c(u) j sign(u) into `offset`.
  void evaluate_secant(const Vector<double>& x) {
    evaluate(x, [this](std::size_t i, double secant, double) {
      stiffness[i] = secant;
      offset[i] = s_[i] * secant * p_.gap;
    });
  }

  std::vector<double> force, stiffness, offset;

 private:
  static constexpr double kFar = 1e4;  // above it two terms of the series of atan are exact in double precision

  template <typename Store>
  void evaluate(const Vector<double>& x, const Store& store) {
    const double kc = p_.contact_stiffness;
    const std::size_t count = g_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double u = x[p_.stops[i]];
      s_[i] = (u > 0.0) - (u < 0.0);
      g_[i] = std::abs(u) - p_.gap;
    }
    if (p_.law == Law::kLinear) {
      for (std::size_t i = 0; i < count; ++i) {
        const double closed = g_[i] > 0.0 ? kc : 0.0;
        store(i, closed, closed);
      }
      return;
    }
    const double lambda = p_.regularization, scale = std::numbers::pi * lambda;
    bool all_far = true;
    for (std::size_t i = 0; i < count; ++i) {
      const double y = scale * g_[i], closed = g_[i] > 0.0 ? 1.0 : 0.0;
      const double inverse = 1.0 / y, square = inverse * inverse;
      all_far &= std::abs(y) > kFar;
      store(i, kc * (closed - std::numbers::inv_pi * inverse * (1.0 - square * (1.0 / 3.0))),
            kc * (closed - std::numbers::inv_pi * (2.0 / 3.0) * inverse * square));
    }
    if (all_far) return;
    for (std::size_t i = 0; i < count; ++i) {
      const double y = scale * g_[i];
      if (std::abs(y) > kFar) continue;
      // 2/pi atan(y) + 1 without cancellation
      const double half = std::numbers::inv_pi * (y < 0.0 ? std::atan(-1.0 / y) : std::atan(y)) + (y < 0.0 ? 0.0 : 0.5);
      store(i, kc * half, kc * (half + lambda * g_[i] / (1.0 + y * y)));
    }
  }

  const Problem& p_;
  std::vector<double> g_, s_;
};

}  // namespace plain

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

struct Motion {
  double x, v, a;
};

/// The quintic through two motions at s = 0 and s = 1, a time h apart.
class Quintic {
  static constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();

 public:
  Quintic(double h, const Motion& from, const Motion& to) : h_(h) {
    const double hv0 = h * from.v, hv1 = h * to.v, ha0 = 0.5 * h * h * from.a, ha1 = 0.5 * h * h * to.a;
    // What the velocities leave of the displacement below its rounding would be a velocity of rounding over h.
    const double moved = 0.5 * (hv0 + hv1) + (ha0 - ha1) / 6.0, rest = to.x - from.x - moved;
    const bool is_rounding = std::abs(rest) <= kRounding * std::max(std::abs(from.x), std::abs(to.x));
    const double rise = (is_rounding ? moved : to.x - from.x) - hv0 - ha0, turn = hv1 - hv0 - 2.0 * ha0,
                 bend = ha1 - ha0;
    c_ = {from.x,
          hv0,
          ha0,
          10.0 * rise - 4.0 * turn + bend,
          -15.0 * rise + 7.0 * turn - 2.0 * bend,
          6.0 * rise - 3.0 * turn + bend};
  }

  double value(double s) const { return ((((c_[5] * s + c_[4]) * s + c_[3]) * s + c_[2]) * s + c_[1]) * s + c_[0]; }
  double slope(double s) const {
    return ((((5.0 * c_[5] * s + 4.0 * c_[4]) * s + 3.0 * c_[3]) * s + 2.0 * c_[2]) * s + c_[1]) / h_;
  }
  double curvature(double s) const {
    return (((20.0 * c_[5] * s + 12.0 * c_[4]) * s + 6.0 * c_[3]) * s + 2.0 * c_[2]) / (h_ * h_);
  }

 private:
  double h_;
  std::array<double, 6> c_;
};

/// Bounds of the error of a quintic through x, v and a at both ends of a step, and of its
/// derivatives.
struct QuinticError {
  double x, v, a;
};

/// These bounds for a motion with |sixth derivative| <= `sixth`: G. Birkhoff and A. Priver, J.
/// Math. Phys. 46 (1967) 440-447, doi 10.1002/sapm1967461440.
inline QuinticError quintic_error(double h, double sixth) {
  const double fourth = h * h * h * h * sixth;
  return {fourth * h * h / 46080.0, fourth * h * (2.2360679774997897 / 30000.0), fourth / 1920.0};
}

/// Replaces both accelerations by those of the cubic through x and v if they do not agree with it:
/// either one departs from the cubic far more than the other, and by more than a tenth of the
/// accelerations, or one exceeds those of the cubic by far. The first occurs if a step ends within
/// a stiff stop, whose acceleration at the last instant would distort the whole interpolant; the
/// second if h omega of a light part is large, since an error e of x at the end, within the
/// tolerance, is an error omega^2 e of a, and of (h omega)^2 e/64 in the middle of the step. In
/// smooth motion one acceleration may agree with the cubic by chance, if the fourth derivative
/// vanishes; then both are close to it. About an extremum of t^2m (m = 2 to 4) the largest departure is
/// 2 to 6 times the accelerations of the cubic.
inline void leave_out_kinks(double h, Motion& from, Motion& to) {
  constexpr double kFarMore = 10.0, kMuch = 0.1, kInconsistent = 10.0;
  const double rise = 6.0 * (to.x - from.x) / h;
  const double a0 = (rise - 4.0 * from.v - 2.0 * to.v) / h, a1 = (2.0 * from.v + 4.0 * to.v - rise) / h;
  const double off0 = std::abs(from.a - a0), off1 = std::abs(to.a - a1);
  const double most = std::max(off0, off1);
  const bool is_kink =
      most > kFarMore * std::min(off0, off1) && most > kMuch * std::max(std::abs(from.a), std::abs(to.a));
  if (!is_kink && most <= kInconsistent * std::max(std::abs(a0), std::abs(a1))) return;
  from.a = a0;
  to.a = a1;
}

/// Interpolates with the quintic through x, v and a at both ends of a step, for methods of order 5
/// or more.
class QuinticInterpolant final : public time::Interpolant {
 public:
  time::Interpolation interpolation() const override { return time::Interpolation::quintic; }
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override;
};

inline void QuinticInterpolant::interpolate(const time::State& from, const time::State& to, double t,
                                            std::span<const Index> dofs, time::Interpolated out) {
  const double h = to.t - from.t, s = (t - from.t) / h;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Index d = dofs[i];
    if (s == 0.0 || s == 1.0) {
      const time::State& end = s == 0.0 ? from : to;
      if (!out.x.empty()) out.x[i] = end.x[d];
      if (!out.v.empty()) out.v[i] = end.v[d];
      if (!out.a.empty()) out.a[i] = end.a[d];
      continue;
    }
    Motion begin = {from.x[d], from.v[d], from.a[d]}, end = {to.x[d], to.v[d], to.a[d]};
    leave_out_kinks(h, begin, end);
    const Quintic course(h, begin, end);
    if (!out.x.empty()) out.x[i] = course.value(s);
    if (!out.v.empty()) out.v[i] = course.slope(s);
    if (!out.a.empty()) out.a[i] = course.curvature(s);
  }
}

}  // namespace butee::integrators

#pragma once

#include <array>

namespace butee::integrators {

struct Motion {
  double x, v, a;
};

/// The quintic through two motions at s = 0 and s = 1, a time h apart.
class Quintic {
 public:
  Quintic(double h, const Motion& from, const Motion& to) : h_(h) {
    const double hv0 = h * from.v, hv1 = h * to.v, ha0 = 0.5 * h * h * from.a, ha1 = 0.5 * h * h * to.a;
    const double rise = to.x - from.x - hv0 - ha0, turn = hv1 - hv0 - 2.0 * ha0, bend = ha1 - ha0;
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

}  // namespace butee::integrators

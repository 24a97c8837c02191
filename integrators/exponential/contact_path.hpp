#pragma once

#include <algorithm>
#include <array>

namespace butee::integrators {

/// The displacement of a stop over a step: a polynomial of degree 4 in the position s in [0, 1].
class ContactPath {
 public:
  /// The cubic through the displacements and speeds (times h) at both ends, plus 16 s^2 (1-s)^2 quartic: `quartic` is
  /// the displacement in the middle minus that of the cubic.
  ContactPath(double w0, double hv0, double w1, double hv1, double quartic) {
    const double rise = w1 - w0, b = 16.0 * quartic;
    c_ = {w0, hv0, 3.0 * rise - 2.0 * hv0 - hv1 + b, hv0 + hv1 - 2.0 * rise - 2.0 * b, b};
    // The cubic's Bernstein coefficients, raised by a degree; the quartic term has only the one in the middle.
    const double p1 = w0 + hv0 / 3.0, p2 = w1 - hv1 / 3.0;
    const double b1 = 0.25 * w0 + 0.75 * p1, b2 = 0.5 * (p1 + p2) + b / 6.0, b3 = 0.75 * p2 + 0.25 * w1;
    lowest_ = std::min(std::min(std::min(w0, w1), std::min(b1, b3)), b2);
    highest_ = std::max(std::max(std::max(w0, w1), std::max(b1, b3)), b2);
  }

  double value(double s) const { return (((c_[4] * s + c_[3]) * s + c_[2]) * s + c_[1]) * s + c_[0]; }
  const std::array<double, 5>& coefficients() const { return c_; }
  /// Bounds of the path: the extreme Bernstein coefficients.
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  double slope(double s) const { return ((4.0 * c_[4] * s + 3.0 * c_[3]) * s + 2.0 * c_[2]) * s + c_[1]; }
  /// The last argument of the constructor.
  double quartic() const { return c_[4] / 16.0; }
  /// The path over [0, s].
  ContactPath until(double s) const {
    const double hv0 = s * c_[1], w1 = value(s), hv1 = s * slope(s);
    return {c_[0], hv0, w1, hv1, value(0.5 * s) - 0.5 * (c_[0] + w1) - 0.125 * (hv0 - hv1)};
  }
  /// The path over [s, 1].
  ContactPath after(double s) const {
    const double length = 1.0 - s, w0 = value(s), w1 = value(1.0), hv0 = length * slope(s), hv1 = length * slope(1.0);
    return {w0, hv0, w1, hv1, value(s + 0.5 * length) - 0.5 * (w0 + w1) - 0.125 * (hv0 - hv1)};
  }
  /// True if the Bernstein coefficients of the slope have one sign, which is sufficient for a
  /// monotonic path.
  bool is_monotonic() const {
    const double d1 = c_[1] + (2.0 / 3.0) * c_[2], d2 = d1 + (2.0 / 3.0) * c_[2] + c_[3],
                 d3 = c_[1] + 2.0 * c_[2] + 3.0 * c_[3] + 4.0 * c_[4];
    return (c_[1] > 0.0 && d1 > 0.0 && d2 > 0.0 && d3 > 0.0) || (c_[1] < 0.0 && d1 < 0.0 && d2 < 0.0 && d3 < 0.0);
  }

 private:
  std::array<double, 5> c_;
  double lowest_, highest_;
};

}  // namespace butee::integrators

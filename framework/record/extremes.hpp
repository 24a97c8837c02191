#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "butee/core/bytes.hpp"
#include "butee/time/simulation.hpp"

namespace butee::record {

/// A displacement, its velocity and its acceleration at an instant.
struct Point {
  double t = 0.0;            ///< s
  std::array<double, 3> of;  ///< x, v and a
};

/// The smallest and the largest value so far, with their instants.
struct Range {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  double t_least = 0.0, t_greatest = 0.0;  ///< s

  void take(double t, double value) {
    if (value > greatest) greatest = value, t_greatest = t;
    if (value < least) least = value, t_least = t;
  }
  bool is_empty() const { return !(least <= greatest); }
  /// The largest |value|, 0 if there is none.
  double size() const { return is_empty() ? 0.0 : std::max(std::abs(least), std::abs(greatest)); }
  void save(ByteWriter& to) const;
  void restore(ByteReader& from);
};

/// The displacement of one DOF, or of one relative to another, over an accepted step, and its
/// extremes on the method's dense output.
///
/// Between two points with no breakpoint between them the dense output is a polynomial through
/// both. For Interpolation::other it is near to the quintic, within DenseOutput::departure(). For
/// Interpolation::near_quintic extremes of v are searched wherever the quintic comes within kMargin
/// of the largest so far, or within DenseOutput::departure() if that is larger. All values are those of the dense
/// output itself. The hull of the Bernstein coefficients shows whether any value in between exceeds a range by more
/// than kGood of it, or by more than kGood of its distance from a border: at a stop that is stiff the penetration is a
/// small part of the displacement. If so, halves are examined: halves of the polynomial, or of the interval while the
/// dense output departs from the polynomial by more than that. The search in an interval stops after kMostSamples,
/// which is too few only if a step spans thousands of periods. In very short steps the polynomial's derivatives are
/// differences of rounded displacements; values between the ends then count only if they exceed the range by more than
/// rounding. Checked in tests/verification/peaks_test.cpp.
class BUTEE_EXPORT StepPath {
 public:
  /// The error bound of an extreme, relative to the largest |value|.
  static constexpr double kGood = 1e-10;
  static constexpr int kMostSamples = 65536;
  /// The largest difference between the derivative of the quintic and that of
  /// Interpolation::near_quintic, relative to the largest |value|.
  static constexpr double kMargin = 0.005;

  /// Index b < 0: DOF a alone, and 0 if a is negative too. `kind`: of the step's integrator.
  /// `borders`: displacements at which a stop closes. `rounding`: of x, v and a, where a DOF is a sum over modes that
  /// move others far more. `step` and `borders` must outlive this object.
  StepPath(const time::AcceptedStep& step, time::Interpolation kind, Index a, Index b,
           std::span<const double> borders = {}, const std::array<double, 3>& rounding = {})
      : step_(step), kind_(kind), dofs_{a, b}, borders_(borders), rounding_(rounding) {}
  /// Rounding of sums over modes in a step.
  static std::array<double, 3> rounding_of_sums(const time::AcceptedStep& step);

  static Point point(const time::State& state, Index a, Index b) {
    Point point{state.t, {0.0, 0.0, 0.0}};
    if (a >= 0) point.of = {state.x[a], state.v[a], state.a[a]};
    if (b >= 0) point.of = {point.of[0] - state.x[b], point.of[1] - state.v[b], point.of[2] - state.a[b]};
    return point;
  }
  Point at(double t) const;
  /// The displacement at an instant between two with no breakpoint between them, by the quintic through both where the
  /// dense output is one; for Interpolation::near_quintic both agree within the tolerance.
  double displacement(const Point& from, const Point& to, double t) const;
  /// Bounds of derivative `order` between two instants with no breakpoint between them.
  std::pair<double, double> enclose(std::size_t order, const Point& from, const Point& to) const;

  /// Extends the range by all values of derivative `order` (0, 1 or 2) after an instant up to
  /// another with no breakpoint between them. The range must contain the value at the first
  /// instant.
  void extend(std::size_t order, const Point& from, const Point& to, Range& range) const {
    range.take(to.t, to.of[order]);
    const auto [least, greatest] = bounds_within(order, from, to);
    double margin = margin_of(order, range);
    if (margin > 0.0) margin = std::max(margin, departure(order, from, to));
    if (kind_ == time::Interpolation::other || least < range.least + margin || greatest > range.greatest - margin)
      search(order, from, to, range);
  }

 private:
  double margin_of(std::size_t order, const Range& range) const {
    return kind_ == time::Interpolation::near_quintic && order == 1 ? kMargin * range.size() : 0.0;
  }
  /// The error that an extreme of derivative `order` may have, if bounds of its size are known.
  double good_of(std::size_t order, const Range& range, double bound) const;
  /// Bounds of the polynomials between their ends, by the inner Bernstein coefficients: those of
  /// the quintic, and of the cubic that is used instead if accelerations bend at an end.
  std::pair<double, double> bounds_within(std::size_t order, const Point& from, const Point& to) const {
    const double h = to.t - from.t;
    const auto [x0, v0, a0] = from.of;
    const auto [x1, v1, a1] = to.of;
    if (kind_ == time::Interpolation::cubic) {
      if (order == 0) return std::minmax({x0 + h / 3.0 * v0, x1 - h / 3.0 * v1});
      if (order == 1) return std::minmax({v0 + h / 3.0 * a0, v1 - h / 3.0 * a1});
      return {std::min(a0, a1), std::max(a0, a1)};
    }
    const double c1 = x0 + 0.2 * h * v0, c2 = 2.0 * c1 - x0 + 0.05 * h * h * a0;
    const double c4 = x1 - 0.2 * h * v1, c3 = 2.0 * c4 - x1 + 0.05 * h * h * a1;
    if (order == 0) return std::minmax({c1, c2, c3, c4, x0 + h / 3.0 * v0, x1 - h / 3.0 * v1});
    const double r = 1.0 / h, rise = r * (x1 - x0);
    if (order == 1)
      return std::minmax({v0 + 0.25 * h * a0, 5.0 * r * (c3 - c2), v1 - 0.25 * h * a1, 3.0 * rise - 0.5 * (v0 + v1)});
    return std::minmax({20.0 * r * r * (c3 - 2.0 * c2 + c1), 20.0 * r * r * (c4 - 2.0 * c3 + c2),
                        r * (6.0 * rise - 4.0 * v0 - 2.0 * v1), r * (2.0 * v0 + 4.0 * v1 - 6.0 * rise)});
  }
  std::pair<double, double> enclose(std::size_t order, const Point& from, const Point& to, double departs) const;
  void search(std::size_t order, const Point& from, const Point& to, Range& range) const;
  void halve(std::size_t order, const Point& from, const Point& to, int& samples, Range& range) const;
  /// Bound on the rounding of derivative `order` between two instants: that of sums over modes, and that of
  /// displacements, and of the times over the velocity, divided by the distance of the instants.
  double rounding(std::size_t order, const Point& from, const Point& to) const;
  /// Bound on the difference of derivative `order` between the dense output and the polynomial.
  double departure(std::size_t order, const Point& from, const Point& to) const;

  const time::AcceptedStep& step_;
  time::Interpolation kind_;
  std::array<Index, 2> dofs_;
  std::span<const double> borders_;
  std::array<double, 3> rounding_;
};

}  // namespace butee::record

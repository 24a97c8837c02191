#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "butee/core/bytes.hpp"
#include "butee/time/simulation.hpp"

namespace butee::record {

/// A displacement, its speed and its acceleration at an instant.
struct Point {
  double t = 0.0;            ///< s
  std::array<double, 3> of;  ///< x, v and a
};

/// The smallest and the largest value so far, and when it was taken.
struct Range {
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  double t_least = 0.0, t_greatest = 0.0;  ///< s

  void take(double t, double value) {
    if (value > greatest) greatest = value, t_greatest = t;
    if (value < least) least = value, t_least = t;
  }
  bool is_empty() const { return !(least <= greatest); }
  /// The largest |value|, 0 where there is none.
  double size() const { return is_empty() ? 0.0 : std::max(std::abs(least), std::abs(greatest)); }
  void save(ByteWriter& to) const;
  void restore(ByteReader& from);
};

/// The displacement of one DOF, or of one relative to another, over an accepted step, and its extremes on the method's
/// dense output.
///
/// Between two points that no breakpoint parts the dense output is a polynomial through both, or, of
/// DenseOutput::other, as near to the quintic as Integrator::departure() says; of DenseOutput::near_quintic extremes of
/// v are looked for wherever the quintic comes within kMargin of the largest so far, and all are values of the dense
/// output itself. The hull of its Bernstein coefficients tells whether anything in between goes beyond a range by more
/// than kGood of it. If so, halves are looked at: of the polynomial, or of the interval while the dense output departs
/// from it by more than that. After kMostSamples of an interval it is left as it is: so many are not enough only where
/// a step spans hundreds of turns. Checked in tests/verification/peaks_test.cpp.
class BUTEE_EXPORT StepPath {
 public:
  /// What an extreme may be wrong by, relative to the largest |value|.
  static constexpr double kGood = 1e-10;
  static constexpr int kMostSamples = 4000;
  /// By which the slope of a quintic may miss that of DenseOutput::near_quintic, relative to the largest |value|.
  static constexpr double kMargin = 0.005;

  /// Index b < 0: DOF a alone, and 0 where that is fixed too. `kind`: of the step's integrator. `step` must outlive it.
  StepPath(const time::AcceptedStep& step, time::DenseOutput kind, Index a, Index b)
      : step_(step), kind_(kind), dofs_{a, b} {}

  static Point point(const time::State& state, Index a, Index b) {
    Point point{state.t, {0.0, 0.0, 0.0}};
    if (a >= 0) point.of = {state.x[a], state.v[a], state.a[a]};
    if (b >= 0) point.of = {point.of[0] - state.x[b], point.of[1] - state.v[b], point.of[2] - state.a[b]};
    return point;
  }
  Point at(double t) const;
  /// Bounds of derivative `order` between two instants that no breakpoint parts.
  std::pair<double, double> enclose(std::size_t order, const Point& from, const Point& to) const;

  /// Takes all values of derivative `order` (0, 1 or 2) after an instant up to another that no breakpoint parts from it
  /// into the range, which holds that at the first instant.
  void extend(std::size_t order, const Point& from, const Point& to, Range& range) const {
    range.take(to.t, to.of[order]);
    const auto [least, greatest] = bounds_within(order, from, to);
    const double margin = margin_of(order, range);
    if (kind_ == time::DenseOutput::other || least < range.least + margin || greatest > range.greatest - margin)
      search(order, from, to, range);
  }

 private:
  double margin_of(std::size_t order, const Range& range) const {
    return kind_ == time::DenseOutput::near_quintic && order == 1 ? kMargin * range.size() : 0.0;
  }
  /// Bounds of the polynomials between their ends, by the inner Bernstein coefficients. Those of the quintic and of the
  /// cubic that it is where accelerations bend at an end.
  std::pair<double, double> bounds_within(std::size_t order, const Point& from, const Point& to) const {
    const double h = to.t - from.t;
    const auto [x0, v0, a0] = from.of;
    const auto [x1, v1, a1] = to.of;
    if (kind_ == time::DenseOutput::cubic) {
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
  /// Of derivative `order` of the dense output from that of the polynomial.
  double departure(std::size_t order, const Point& from, const Point& to) const;

  const time::AcceptedStep& step_;
  time::DenseOutput kind_;
  std::array<Index, 2> dofs_;
};

}  // namespace butee::record

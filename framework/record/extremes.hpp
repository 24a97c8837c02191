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
/// An interval is left where bounds show that nothing in it lies beyond the range by more than kGood of that. Others
/// are halved until the cubic through their ends tells the course to kGood, whose stationary points are taken. Bounds
/// follow from the motion at both ends where the dense output is a polynomial through them, else from
/// Integrator::departure(). After kMostSamples of an interval it is left as it is: so many are not enough only where a
/// step spans hundreds of turns. Checked in tests/verification/peaks_test.cpp.
class BUTEE_EXPORT Course {
 public:
  /// What an extreme may be wrong by, relative to the largest |value|.
  static constexpr double kGood = 1e-10;
  static constexpr int kMostSamples = 4000;

  /// Index b < 0: DOF a alone, and 0 where that is fixed too. `step` must outlive it.
  Course(const time::AcceptedStep& step, Index a, Index b) : step_(step), dofs_{a, b} {
    if (a < 0) dofs_ = {b, a}, sign_ = -1.0;
  }

  static Point point(const time::State& state, Index a, Index b) {
    Point point{state.t, {0.0, 0.0, 0.0}};
    if (a >= 0) point.of = {state.x[a], state.v[a], state.a[a]};
    if (b >= 0) point.of = {point.of[0] - state.x[b], point.of[1] - state.v[b], point.of[2] - state.a[b]};
    return point;
  }
  Point at(double t) const;
  /// Bounds of derivative `order` between two instants that no knot parts.
  std::pair<double, double> enclose(std::size_t order, const Point& from, const Point& to) const;

  /// Takes all values of derivative `order` (0, 1 or 2) between two instants that no knot parts into the range.
  void extend(std::size_t order, const Point& from, const Point& to, Range& range) const {
    range.take(from.t, from.of[order]);
    range.take(to.t, to.of[order]);
    if (order == 2 && step_.integrator.dense_output() == time::DenseOutput::cubic) return;
    if (!lies_within(order, from, to, range)) search(order, from, to, range);
  }

 private:
  using Bound = std::array<double, 3>;

  /// A quick bound for polynomials: the cubic and the quintic through x, v and a lie within it, v and a do up to what
  /// departure() adds.
  bool lies_within(std::size_t order, const Point& from, const Point& to, const Range& range) const {
    constexpr double kOfSpeed = 0.2, kOfAcceleration = 0.0175;  // of the quintic Hermite functions; cubic: 4/27
    if (order == 2 || step_.integrator.dense_output() == time::DenseOutput::other) return false;
    if (order == 1 && step_.integrator.dense_output() != time::DenseOutput::cubic) return false;
    const double h = to.t - from.t, y0 = from.of[order], y1 = to.of[order];
    double slack = kOfSpeed * h * (std::abs(from.of[order + 1]) + std::abs(to.of[order + 1]));
    if (order == 0) slack += kOfAcceleration * h * h * (std::abs(from.of[2]) + std::abs(to.of[2]));
    return std::max(y0, y1) + slack <= range.greatest && std::min(y0, y1) - slack >= range.least;
  }
  void search(std::size_t order, const Point& from, const Point& to, Range& range) const;
  void halve(std::size_t order, const Point& from, const Point& to, int& samples, Range& range) const;
  static std::pair<double, double> enclose(std::size_t order, const Point& from, const Point& to, const Bound& departs);
  /// Of the dense output between two points from the cubics by x and v, v and a, and the straight line of a.
  Bound departure(const Point& from, const Point& to) const;
  void take_stationary(std::size_t order, const Point& from, const Point& to, Range& range) const;

  const time::AcceptedStep& step_;
  std::array<Index, 2> dofs_;
  double sign_ = 1.0;
};

}  // namespace butee::record

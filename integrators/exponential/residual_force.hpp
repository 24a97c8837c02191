#pragma once

#include "butee/dynamics/elastic_stops.hpp"

namespace butee::integrators {

/// The residual force of one open stop with a regularised law. Far from the borders of the gap it
/// is constant; for a stop with two sides it changes its sign in the middle of the gap. Zero for a
/// linear law.
class ResidualForce {
 public:
  ResidualForce(const dynamics::ElasticStops& contact, Index stop);

  double largest() const { return largest_; }  ///< N
  /// True if the force jumps in the middle of the gap: for stops with two sides.
  bool jumps() const { return jumps_; }
  /// Bound of the displacement error, m, over one characteristic time of the motion (`steps` steps)
  /// if the force is taken as constant on each side of w = 0 along a path from w0 to w1 with |w| <=
  /// bound. `compliance` is the displacement in the step by 1 N. The error of a varying force grows
  /// with the square of `steps`, that of a jump at the wrong time in proportion to `steps`.
  double constant_error(double w0, double w1, double bound, double compliance, double steps) const;

 private:
  double largest_, bend_, gap_;
  bool jumps_;
};

/// The bound of constant_error() as a fraction of the output tolerance.
inline constexpr double kResidualError = 0.02;

/// The |w| up to which the force of an open stop is constant to 0.3 %, m: ten widths of the law's
/// bend before the border of the gap. -1e100 if the bend is wider than a hundredth of the gap.
double constant_force_limit(const dynamics::ElasticStops& contact, Index stop);

}  // namespace butee::integrators

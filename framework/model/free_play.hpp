#pragma once

#include <cmath>
#include <limits>

namespace butee::model {

enum class Sides { both, positive, negative };

/// The free play of a scalar stop with the displacement w (of node a to ground, or u_a - u_b), m or rad.
///
/// A stop on side s = +1 or -1 closes at s w = gap. With one side the penetration is g = s w - gap for every w, with
/// both g = |w| - gap on the nearer side s = sign(w).
struct FreePlay {
  double gap = 0.0;  ///< on each side
  Sides sides = Sides::both;

  bool has_positive() const { return sides != Sides::negative; }
  bool has_negative() const { return sides != Sides::positive; }
  bool has_both() const { return sides == Sides::both; }
  bool has_side(double side) const { return side > 0.0 ? has_positive() : has_negative(); }

  /// The w at which the positive and the negative side close; infinite for a side without a stop.
  double upper() const { return has_positive() ? gap : std::numeric_limits<double>::infinity(); }
  double lower() const { return has_negative() ? -gap : -std::numeric_limits<double>::infinity(); }

  /// The side of the penetration: +1 or -1, or 0 at w = 0 between two sides.
  double side(double w) const {
    if (sides != Sides::both) return sides == Sides::positive ? 1.0 : -1.0;
    return static_cast<double>(w > 0.0) - static_cast<double>(w < 0.0);
  }
  /// g; negative while the stop is open
  double penetration(double w) const {
    if (sides != Sides::both) return (sides == Sides::positive ? w : -w) - gap;
    return std::abs(w) - gap;
  }
  /// The side that is closed, +1 or -1; 0 while the stop is open.
  double closed_side(double w) const { return penetration(w) > 0.0 ? side(w) : 0.0; }
};

}  // namespace butee::model

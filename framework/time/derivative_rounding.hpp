#pragma once

#include <cmath>
#include <limits>

namespace butee::time {

/// A bound on the rounding of derivative `order` (1 or 2) of the quintic through a motion with about this displacement
/// and speed at the ends of an interval h before t: differences of rounded displacements and of rounded times, divided
/// by h or h^2. In very short steps it exceeds the change of the derivative itself. Not installed.
inline double derivative_rounding(int order, double displacement, double speed, double t, double h) {
  // The largest coefficients of the derivatives of the quintic, and of sums of both ends.
  constexpr double kFirst = 8.0, kSecond = 32.0;
  const double by_x = (displacement + speed * std::abs(t)) / h;
  return std::numeric_limits<double>::epsilon() * (order == 1 ? kFirst * by_x : kSecond * (by_x + speed) / h);
}

}  // namespace butee::time

#pragma once

#include <array>
#include <cstddef>

namespace butee::integrators {

/// The coefficients of a stop's force over a step in the Legendre polynomials P_0, P_1, P_2 of [0, 1], N.
inline constexpr std::size_t kForceMoments = 3;
using ForceMoments = std::array<double, kForceMoments>;

/// The moments of a force over a step from its integrals against 1, s and s^2.
inline ForceMoments moments_from_powers(double m0, double m1, double m2) {
  return {m0, 3.0 * (2.0 * m1 - m0), 5.0 * (6.0 * m2 - 6.0 * m1 + m0)};
}

/// The moments over [a, b] of the force whose moments over [0, 1] are f. With L = b - a and c = a +
/// b - 1, the polynomials of [0, 1] are expressed by those of [a, b]: P_1 becomes L P_1 + c, and
/// P_2 becomes L^2 P_2 + 3 L c P_1 + (L^2 + 3 c^2 - 1)/2.
template <class T>
std::array<T, 3> moments_within(const std::array<T, 3>& f, double a, double b) {
  const double length = b - a, c = a + b - 1.0;
  return {T(f[0] + c * f[1] + 0.5 * (length * length + 3.0 * c * c - 1.0) * f[2]),
          T(length * f[1] + 3.0 * length * c * f[2]), T(length * length * f[2])};
}

/// Displacement at the end, h times the speed at the end and displacement in the middle (rows) due
/// to unit forces P_0, P_1, P_2 (columns), m/N.
using PathCoupling = std::array<std::array<double, 3>, 3>;

/// Force moments along a path, and the integrals of 1, s, ..., s^6 over the parts of the step in
/// which the stop is closed. The integrals give the derivative of the moments with respect to the
/// path.
struct Projection {
  ForceMoments force{};
  std::array<double, 7> closed{};
};

}  // namespace butee::integrators

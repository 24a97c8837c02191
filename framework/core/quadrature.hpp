#pragma once

#include <array>

namespace butee {

/// An instant and its weight in an integral, s.
struct QuadraturePoint {
  double t, weight;
};

/// Gauss' rule with five points from `begin` to `end`, exact for polynomials of degree 9.
inline std::array<QuadraturePoint, 5> gauss_points(double begin, double end) {
  const double half = 0.5 * (end - begin), middle = begin + half;
  const double inner = 0.53846931010568309104 * half, outer = 0.90617984593866399280 * half;
  const double inner_weight = 0.47862867049936646804 * half, outer_weight = 0.23692688505618908751 * half;
  return {{{middle - outer, outer_weight},
           {middle - inner, inner_weight},
           {middle, 128.0 / 225.0 * half},
           {middle + inner, inner_weight},
           {middle + outer, outer_weight}}};
}

/// Lagrange's polynomial of point k of a rule at t: 1 at that point, 0 at the others.
template <std::size_t kPoints>
double lagrange_at(double t, const std::array<QuadraturePoint, kPoints>& points, std::size_t k) {
  double value = 1.0;
  for (std::size_t i = 0; i < kPoints; ++i)
    if (i != k) value *= (t - points[i].t) / (points[k].t - points[i].t);
  return value;
}

}  // namespace butee

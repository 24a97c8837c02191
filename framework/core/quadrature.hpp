#pragma once

#include <algorithm>
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
  // Within a few roundings of t a sum may lie beyond the end.
  return {{{std::max(begin, middle - outer), outer_weight},
           {std::max(begin, middle - inner), inner_weight},
           {middle, 128.0 / 225.0 * half},
           {std::min(end, middle + inner), inner_weight},
           {std::min(end, middle + outer), outer_weight}}};
}

/// The weight of a point in a rule, and in the rule that has only every second of its points, s.
struct NestedPoint {
  double t, weight, coarse_weight;
};

/// Kronrod's rule with 15 points, exact for polynomials of degree 22, and Gauss' rule with seven of them, exact for
/// degree 13. Places and weights: R. Piessens et al., QUADPACK, Springer 1983.
inline std::array<NestedPoint, 15> kronrod_points(double begin, double end) {
  constexpr std::array<double, 8> kPlaces = {0.0,
                                             0.20778495500789846760,
                                             0.40584515137739716691,
                                             0.58608723546769113029,
                                             0.74153118559939443986,
                                             0.86486442335976907279,
                                             0.94910791234275852453,
                                             0.99145537112081263921};
  constexpr std::array<double, 8> kWeights = {0.20948214108472782801, 0.20443294007529889241, 0.19035057806478540991,
                                              0.16900472663926790283, 0.14065325971552591875, 0.10479001032225018384,
                                              0.06309209262997855329, 0.02293532201052922496};
  constexpr std::array<double, 4> kCoarse = {0.41795918367346938776, 0.38183005050511894495, 0.27970539148927666790,
                                             0.12948496616886969327};
  const double half = 0.5 * (end - begin), middle = begin + half;
  std::array<NestedPoint, 15> points{};
  for (std::size_t k = 0; k < kPlaces.size(); ++k) {
    const double weight = half * kWeights[k], coarse = k % 2 == 0 ? half * kCoarse[k / 2] : 0.0;
    points[7 - k] = {std::max(begin, middle - half * kPlaces[k]), weight, coarse};
    points[7 + k] = {std::min(end, middle + half * kPlaces[k]), weight, coarse};
  }
  return points;
}

/// Lagrange's polynomial of point k of a rule at t: 1 at that point, 0 at the others.
template <class Points>
double lagrange_at(double t, const Points& points, std::size_t k) {
  double value = 1.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i != k) value *= (t - points[i].t) / (points[k].t - points[i].t);
  return value;
}

}  // namespace butee

#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

#include "butee/core/types.hpp"

namespace butee::integrators {

/// Where a step is searched for crossings of a border, as fractions of its length.
struct CrossingRange {
  double begin = 0.0;  ///< crossings before it do not count for a border on which the step starts
  double last = 1.0;
  double rounding = 0.0;  ///< values that differ from the border by at most this are on it
};

/// The collocation nodes of a step, positions from 0 to 1: the six points of Lobatto's rule and the
/// middle.
struct StepNodes {
  static constexpr Index kCount = 7, kMiddle = 3, kEnd = 6;
  static const std::array<double, kCount> kPlaces;
  using Matrix = Eigen::Matrix<double, kCount, kCount>;
  using Row = Eigen::Matrix<double, 1, kCount>;

  /// Values f (n x 7) at the nodes times this matrix are the coefficients of 1, s, ..., s^6 of the
  /// polynomial through them.
  static const Matrix& with_middle();
  /// The same for the polynomial of degree 5 that ignores the value in the middle.
  static const Matrix& without_middle();
  /// Values at the nodes times this matrix are the coefficients a_0, ..., a_6 of the polynomial
  /// through them in the Legendre polynomials of [0, 1].
  static const Matrix& legendre();
  /// The error of Lobatto's rule for the integral of a function with these Legendre coefficients:
  /// kRule |a_10|, with a_10 extrapolated from a_3 to a_6 under the assumption of geometric decay.
  static double quadrature_error(const Row& coefficients);
  /// The largest error within the step of the integral of a function with these Legendre coefficients,
  /// if the polynomial through its values at the nodes is integrated: kInner (|a_7| + |a_8|),
  /// extrapolated in the same way.
  static double inner_error(const Row& coefficients);
  /// The integrals of P_7 and P_8 less the polynomials through their values at the nodes reach 0.057
  /// and 0.095.
  static constexpr double kInner = 0.1;
  /// Lobatto's rule with six points gives 0.3174 for the integral of P_10 over [0, 1]; the exact
  /// value is 0.
  static constexpr double kRule = 0.3174;
  /// The weights of the values at the nodes in the polynomial's value at position `place`.
  static Eigen::Matrix<double, kCount, 1> lagrange(double place);
  /// The weights of the values at the nodes, and of the derivatives by the position at both ends, in the value at
  /// `place` of the polynomial of degree 8 that has all of them (Hermite's at the ends).
  struct Hermite {
    Eigen::Matrix<double, kCount, 1> values;
    double begin_slope, end_slope;
  };
  static Hermite hermite(double place);
  /// A sine of frequency |lambda| differs from the polynomial through its values at the nodes by
  /// less than kMiss w^7, w = |lambda| h; kMiss is 1/7! times kProduct, a bound of the product of the
  /// distances from the nodes, which is at most 2.2e-4.
  static constexpr double kProduct = 3e-4, kMiss = kProduct / 5040.0;
  /// Interpolation error of a sine of unit amplitude with w = |lambda| h, at most 2.
  static double missed_part(double w) {
    const double square = w * w;
    return std::min(2.0, kMiss * square * square * square * w);
  }

  /// The position at which a polynomial, given by its coefficients, first crosses a border in the
  /// range; range.last if it does not. The polynomial is sampled at 32 positions up to 1, and at
  /// range.last if that exceeds 1. A start that is much nearer to the border than the first sample
  /// counts as on the border and does not cross it.
  static double first_crossing(const Row& coefficients, double border, const CrossingRange& range);
};

}  // namespace butee::integrators

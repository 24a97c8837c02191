#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Core>

#include "butee/core/types.hpp"

namespace butee::integrators {

/// The places in a step, from 0 to 1, at which collocation takes forces: the six points of Lobatto's rule and the
/// middle.
struct StepNodes {
  static constexpr Index kCount = 7, kMiddle = 3, kEnd = 6;
  static const std::array<double, kCount> kPlaces;
  using Matrix = Eigen::Matrix<double, kCount, kCount>;
  using Row = Eigen::Matrix<double, 1, kCount>;

  /// Values f (n x 7) at the nodes times it are the coefficients of 1, s, ..., s^6 of the polynomial through them.
  static const Matrix& with_middle();
  /// The same for the polynomial of degree 5 that leaves the value in the middle out.
  static const Matrix& without_middle();
  /// Values at the nodes times it are the coefficients a_0, ..., a_6 of the polynomial through them in Legendre's
  /// polynomials on [0, 1].
  static const Matrix& legendre();
  /// The error of Lobatto's rule over the integral of a function with these coefficients: kRule |a_10|, where a_10
  /// follows from a_3 to a_6 as if the coefficients fell like powers.
  static double quadrature_error(const Row& coefficients);
  /// Lobatto's rule with six points gives 0.3174 for the integral of P_10 over [0, 1], which is 0.
  static constexpr double kRule = 0.3174;
  /// The weights of the values at the nodes in the polynomial's value at a place.
  static Eigen::Matrix<double, kCount, 1> lagrange(double place);
  /// A sine of w = |lambda| h differs from the polynomial through its values at the nodes by less than kMiss w^7: 1/7!
  /// times the largest product of the distances from the nodes, 3e-4.
  static constexpr double kMiss = 3e-4 / 5040.0;
  /// The part of a sine of w that the polynomial misses, at most 2.
  static double missed_part(double w) {
    const double square = w * w;
    return std::min(2.0, kMiss * square * square * square * w);
  }

  /// Where a polynomial, given by coefficients, first crosses a border before `last`; `last` where it does not. It is
  /// looked at 32 times up to 1, and at `last` where that is more. A start much nearer to the border than the first of
  /// these lies on it and crosses nothing.
  static double first_crossing(const Row& coefficients, double border, double last);
};

}  // namespace butee::integrators

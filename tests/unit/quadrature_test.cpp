#include <cmath>

#include <butee/core/quadrature.hpp>
#include <gtest/gtest.h>

namespace butee::test::quadrature_test {
namespace {

/// The integral of t^degree from -1 to 2 by its antiderivative.
double truth(int degree) {
  return (std::pow(2.0, degree + 1) - std::pow(-1.0, degree + 1)) / (degree + 1);
}

TEST(Quadrature, IsExactForPolynomialsOfItsDegree) {
  for (int degree = 0; degree <= 24; ++degree) {
    double gauss = 0.0, coarse = 0.0, fine = 0.0;
    for (const auto& [t, weight] : gauss_points(-1.0, 2.0)) gauss += weight * std::pow(t, degree);
    for (const auto& [t, weight, coarse_weight] : kronrod_points(-1.0, 2.0)) {
      fine += weight * std::pow(t, degree);
      coarse += coarse_weight * std::pow(t, degree);
    }
    const double exact = truth(degree), rounding = 1e-14 * std::abs(exact) + 1e-14;
    EXPECT_EQ(std::abs(gauss - exact) <= rounding, degree <= 9) << degree;
    EXPECT_EQ(std::abs(coarse - exact) <= rounding, degree <= 13) << degree;
    // The symmetric rule of degree 22 also takes 23.
    EXPECT_EQ(std::abs(fine - exact) <= rounding, degree <= 23) << degree;
  }
}

TEST(Quadrature, LagrangesPolynomialContinuesAPolynomial) {
  const auto points = kronrod_points(0.0, 1.0);
  double sum = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) sum += lagrange_at(0.0, points, k) * std::pow(points[k].t - 0.5, 9);
  EXPECT_NEAR(sum, std::pow(-0.5, 9), 1e-14);
}

/// Points lie in the interval even if it is a few roundings of t long, where their sums round beyond its ends.
TEST(Quadrature, PointsOfTinyIntervalsLieWithin) {
  for (const double begin : {1.0, 0.3, 2.0 - 1e-15}) {
    double end = begin;
    for (int i = 0; i < 40; ++i) {
      end = std::nextafter(end, 3.0);
      const auto check = [&](const auto& points) {
        for (const auto& point : points) {
          EXPECT_GE(point.t, begin);
          EXPECT_LE(point.t, end);
        }
      };
      check(gauss_points(begin, end));
      check(kronrod_points(begin, end));
    }
  }
}

}  // namespace
}  // namespace butee::test::quadrature_test

#include "integrators/exponential/step_nodes.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace butee::integrators {
namespace {

constexpr Index kCount = StepNodes::kCount;

/// The largest |int_0^s (f - p)| over the step, p being the polynomial through the values of f at the nodes, by the
/// trapezoidal rule with 20 000 intervals.
template <class Function>
double integral_error(const Function& f, const StepNodes::Row& values) {
  constexpr int kIntervals = 20000;
  double sum = 0.0, largest = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double s = static_cast<double>(i) / kIntervals;
    sum += (f(s) - values.dot(StepNodes::lagrange(s).transpose())) / kIntervals;
    largest = std::max(largest, std::abs(sum));
  }
  return largest;
}

/// Friction with tanh that reverses within the step, more or less abruptly: the estimate is neither far too small nor
/// far too large.
TEST(StepNodes, EstimateTheErrorOfVelocitiesWithinAStep) {
  // The estimate may reach one tolerance, the promise is ten.
  constexpr double kTooSmall = 0.25, kTooLarge = 30.0;
  int compared = 0;
  for (const double steepness : {1.0, 2.0, 3.0, 5.0, 8.0})
    for (const double place : {0.3, 0.5, 0.62}) {
      const auto f = [&](double s) { return std::tanh(2.0 * steepness * (s - place)); };
      StepNodes::Row values;
      for (Index j = 0; j < kCount; ++j) values[j] = f(StepNodes::kPlaces[static_cast<std::size_t>(j)]);
      const double error = integral_error(f, values), estimate = StepNodes::inner_error(values * StepNodes::legendre());
      EXPECT_GT(estimate, kTooSmall * error) << steepness << " " << place;
      EXPECT_LT(estimate, kTooLarge * error) << steepness << " " << place;
      ++compared;
    }
  EXPECT_EQ(compared, 15);
}

/// Polynomials up to degree 4 are exact, and their estimate is rounding.
TEST(StepNodes, EstimateNoErrorOfLowPolynomials) {
  StepNodes::Row values;
  for (Index j = 0; j < kCount; ++j) {
    const double s = StepNodes::kPlaces[static_cast<std::size_t>(j)];
    values[j] = 1.0 - 2.0 * s + 3.0 * s * s * s * s;
  }
  EXPECT_LT(StepNodes::inner_error(values * StepNodes::legendre()), 1e-14);
  EXPECT_LT(StepNodes::quadrature_error(values * StepNodes::legendre()), 1e-14);
}

/// Seven values and two slopes determine a polynomial of degree 8.
TEST(StepNodes, InterpolatePolynomialsOfDegreeEightWithTheSlopesAtBothEnds) {
  const auto f = [](double s) { return 0.5 - 3.0 * s + std::pow(s - 0.3, 5) + 7.0 * std::pow(s - 0.6, 8); };
  const auto slope = [](double s) { return -3.0 + 5.0 * std::pow(s - 0.3, 4) + 56.0 * std::pow(s - 0.6, 7); };
  const auto at = [&](double place) {
    const auto [values, begin, end] = StepNodes::hermite(place);
    double sum = begin * slope(0.0) + end * slope(1.0);
    for (Index j = 0; j < kCount; ++j) sum += values[j] * f(StepNodes::kPlaces[static_cast<std::size_t>(j)]);
    return sum;
  };
  for (const double place : {0.0, 1e-9, 0.05, 0.31, 0.5, 0.77, 0.999, 1.0}) EXPECT_NEAR(at(place), f(place), 1e-14);
  constexpr double kNear = 1e-7;
  EXPECT_NEAR((at(kNear) - at(0.0)) / kNear, slope(0.0), 1e-5);
  EXPECT_NEAR((at(1.0) - at(1.0 - kNear)) / kNear, slope(1.0), 1e-5);
}

}  // namespace
}  // namespace butee::integrators

// The order conditions of Rosenbrock methods (Hairer and Wanner, Solving Ordinary Differential Equations II,
// table IV.7.1) for the coefficients of rodas4, transformed back from the form used in the code.
#include "integrators/rodas4_coefficients.hpp"

#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace butee::test::rodas4_coefficients_test {
namespace {

using namespace integrators::rodas4_coefficients;
using Matrix = Eigen::Matrix<double, 6, 6>;
using Column = Eigen::Matrix<double, 6, 1>;

/// Rounding of sums of some twenty products of size 10.
constexpr double kRounding = 5e-14;

struct Method {
  Matrix alpha, gamma;
  Column weights, embedded;
};

Method method() {
  Matrix a = Matrix::Zero(), c = Matrix::Zero();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j) {
      a(i, j) = kA[i][j];
      c(i, j) = kC[i][j];
    }
  const Matrix gamma = (Matrix::Identity() / kGamma - c).inverse();
  Column last = a.row(5).transpose(), all = last;
  all[5] = 1.0;
  return {a * gamma, gamma, (all.transpose() * gamma).transpose(), (last.transpose() * gamma).transpose()};
}

void expect_order(const Method& method, const Column& b, int order) {
  const Matrix beta = method.alpha + method.gamma;
  const Column a = method.alpha.rowwise().sum(), beta_sum = beta.rowwise().sum();
  EXPECT_NEAR(b.sum(), 1.0, kRounding);
  EXPECT_NEAR(b.dot(beta_sum), 1.0 / 2, kRounding);
  EXPECT_NEAR(b.dot(a.cwiseAbs2()), 1.0 / 3, kRounding);
  EXPECT_NEAR(b.dot(beta * beta_sum), 1.0 / 6, kRounding);
  if (order < 4) return;
  EXPECT_NEAR(b.dot(a.cwiseProduct(a.cwiseAbs2())), 1.0 / 4, kRounding);
  EXPECT_NEAR(b.dot(a.cwiseProduct(method.alpha * beta_sum)), 1.0 / 8, kRounding);
  EXPECT_NEAR(b.dot(beta * a.cwiseAbs2()), 1.0 / 12, kRounding);
  EXPECT_NEAR(b.dot(beta * (beta * beta_sum)), 1.0 / 24, kRounding);
}

TEST(Rodas4Coefficients, MeetTheConditionsOfOrderFourToRounding) {
  expect_order(method(), method().weights, 4);
}

TEST(Rodas4Coefficients, MeetThoseOfOrderThreeInTheEmbeddedFormula) {
  expect_order(method(), method().embedded, 3);
}

TEST(Rodas4Coefficients, TakeLoadsWhereTheirStagesStand) {
  const Column times = method().alpha.rowwise().sum(), rates = method().gamma.rowwise().sum();
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(times[i], kTimes[static_cast<std::size_t>(i)], kRounding) << i;
    EXPECT_NEAR(rates[i], kRates[static_cast<std::size_t>(i)], kRounding) << i;
  }
}

/// The dense output of y' = z y + g(t) at s in a step h = 1 from y = `start`.
double dense_output(double z, double start, double (*g)(double), double slope, double s) {
  std::array<double, 6> u{};
  double y = start;
  for (std::size_t i = 0; i < u.size(); ++i) {
    double sum = 0.0;
    y = start;
    for (std::size_t j = 0; j < i; ++j) {
      y += kA[i][j] * u[j];
      sum += kC[i][j] * u[j];
    }
    u[i] = (z * y + g(kTimes[i]) + sum + kRates[i] * slope) / (1.0 / kGamma - z);
  }
  const double end = y + u.back();
  double d = 0.0, e = 0.0;
  for (std::size_t j = 0; j < kFirst.size(); ++j) {
    d += kFirst[j] * u[j];
    e += kSecond[j] * u[j];
  }
  return (1.0 - s) * start + s * (end + (1.0 - s) * (d + s * e));
}

/// Published digits: the conditions hold to 1e-9.
TEST(Rodas4Coefficients, DenseOutputHasOrderThree) {
  for (const double s : {0.2, 0.5, 0.9}) {
    EXPECT_NEAR(dense_output(
                    0.0, 0.0, [](double) { return 1.0; }, 0.0, s),
                s, 1e-9);
    EXPECT_NEAR(dense_output(
                    0.0, 0.0, [](double t) { return 2.0 * t; }, 2.0, s),
                s * s, 1e-9);
    EXPECT_NEAR(dense_output(
                    0.0, 0.0, [](double t) { return 3.0 * t * t; }, 0.0, s),
                s * s * s, 1e-9);
    const auto error = [s](double z) {
      return std::abs(dense_output(
                          z, 1.0, [](double) { return 0.0; }, 0.0, s) -
                      std::exp(s * z));
    };
    for (const double z : {0.08, 0.04, 0.02}) EXPECT_LT(error(z), 0.1 * std::pow(z, 4.0)) << s << ' ' << z;
  }
}

}  // namespace
}  // namespace butee::test::rodas4_coefficients_test

// A search that cannot miss a root, on functions whose roots are known by dense sampling.
#include "integrators/first_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace butee::test::first_change_test {
namespace {

using integrators::safe_step;

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(SafeStep, IsTheRootOfAParabola) {
  EXPECT_DOUBLE_EQ(safe_step(2.0, -1.0, 0.0, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(safe_step(1.0, 0.0, -2.0, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(safe_step(0.0, 3.0, -2.0, 0.0), 3.0);
  EXPECT_EQ(safe_step(1.0, -1.0, 0.6, 0.0), kNever);
  EXPECT_EQ(safe_step(1.0, 1.0, 1.0, 0.0), kNever);
}

/// A sum of cosines with a bound of its third derivative.
struct Cosines {
  std::array<double, 4> amplitude, rate, phase;
  double offset;

  double derivative(int k, double s) const {
    double sum = k == 0 ? offset : 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += amplitude[i] * std::pow(rate[i], k) * std::cos(rate[i] * s + phase[i] + 0.5 * M_PI * k);
    return sum;
  }
  double third() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += std::abs(amplitude[i]) * std::pow(rate[i], 3);
    return sum;
  }
};

TEST(SafeStep, NeverPassesARootAndReachesIt) {
  constexpr int kFunctions = 300, kLooks = 4000;
  constexpr double kEnd = 5.0, kSampling = 1e-4;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int roots = 0, grazing = 0;
  for (int f = 0; f < kFunctions; ++f) {
    Cosines g{};
    for (std::size_t i = 0; i < 4; ++i) {
      g.amplitude[i] = uniform(random) - 0.5;
      g.rate[i] = std::exp(6.0 * uniform(random) - 2.0);
      g.phase[i] = 6.3 * uniform(random);
    }
    double least = kNever;
    for (double s = 0.0; s < kEnd; s += kSampling) least = std::min(least, g.derivative(0, s));
    // Some functions stay far from zero, some nearly touch it, and some cross it.
    const double lift = f % 3 == 0 ? 0.3 : f % 3 == 1 ? 1e-7 : -0.2;
    g.offset = lift - least;
    if (!(g.derivative(0, 0.0) > 0.0)) continue;
    double s = 0.0;
    int looks = 0;
    while (s < kEnd && looks < kLooks) {
      const double value = g.derivative(0, s);
      if (value < 1e-13) break;
      const double step = safe_step(value, g.derivative(1, s), g.derivative(2, s), g.third());
      ASSERT_GT(step, 0.0);
      for (int i = 1; i < 50; ++i) ASSERT_GT(g.derivative(0, std::min(s + step * i / 50.0, kEnd)), -1e-13);
      s += step;
      ++looks;
    }
    ASSERT_LT(looks, kLooks);
    if (s < kEnd) {
      EXPECT_NEAR(g.derivative(0, s), 0.0, 1e-12);
      ++roots;
    } else if (f % 3 == 1) {
      ++grazing;
    }
  }
  EXPECT_GT(roots, 60);
  EXPECT_GT(grazing, 60);
}

}  // namespace
}  // namespace butee::test::first_change_test

// Distinguishes exponential growth from growth like t, a jump, decay, and growth with scatter.
#include <cmath>
#include <functional>

#include <butee/record/growth.hpp>
#include <gtest/gtest.h>

namespace butee::test::growth_test {
namespace {

record::Growth growth_of(const std::function<double(double)>& log, double end) {
  constexpr int kInstants = 1000;
  record::Growth growth;
  for (int i = 0; i <= kInstants; ++i) {
    growth.times.push_back(end * i / kInstants);
    growth.logs.push_back(log(growth.times.back()));
    if (i > 0) growth.displacement_logs.push_back(growth.logs.back());
  }
  return growth;
}

TEST(Growth, OfExponentialMotionIsItsRate) {
  const auto growth = growth_of([](double t) { return 9.0 * t + std::sin(40.0 * t); }, 2.0);
  EXPECT_NEAR(growth.exponential().rate, 9.0, 0.2);  // the sine adds less than 1/3 over 1.75 s
  EXPECT_EQ(growth.exponential().until, 2.0);
}

TEST(Growth, OfMotionThatSettlesIsItsRateUpToThere) {
  const auto rate = growth_of([](double t) { return 9.0 * std::min(t, 1.3); }, 4.0).exponential();
  EXPECT_NEAR(rate.rate, 9.0, 0.2);
  EXPECT_NEAR(rate.until, 1.3, 0.15);  // within a factor e of the largest value
}

TEST(Growth, IsNotExponentialWhereItIsAPowerOfTimeAJumpOrFading) {
  for (const double power : {1.0, 2.0, 3.0})
    for (const double scale : {1.0, 1e3, 1e6}) {
      const auto growth =
          growth_of([=](double t) { return power * std::log1p(scale * t) + 0.5 * std::cos(97.0 * t); }, 2.0);
      EXPECT_EQ(growth.exponential().rate, 0.0) << power << " " << scale;
    }
  for (const double at : {0.1, 0.5, 1.0, 1.7})
    EXPECT_EQ(growth_of([=](double t) { return t < at ? 0.0 : 12.0; }, 2.0).exponential().rate, 0.0) << at;
  EXPECT_EQ(growth_of([](double t) { return -9.0 * t; }, 2.0).exponential().rate, 0.0);
  EXPECT_EQ(growth_of([](double) { return 0.0; }, 2.0).exponential().rate, 0.0);
  EXPECT_EQ(record::Growth{}.exponential().rate, 0.0);
}

TEST(Growth, BetweenTwoInstantsIsTheLargestRise) {
  // Decays to e^-50, then grows to e^-30: an error made at the minimum has grown by e^20.
  const auto growth = growth_of([](double t) { return t < 1.0 ? -50.0 * t : -50.0 + 20.0 * (t - 1.0); }, 2.0);
  EXPECT_NEAR(growth.log_between(2.0), 20.0, 1e-9);
  EXPECT_EQ(growth.log_between(0.9), 0.0);
  EXPECT_EQ(growth.amplification(), 1.0);
}

}  // namespace
}  // namespace butee::test::growth_test

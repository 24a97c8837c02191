// Predicting a run from its beginning: even histories are extrapolated, uneven ones are not.
#include "apps/butee/check/pace.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace butee::test::pace_test {
namespace {

using app::check::Pace;

/// A history f(t) from t = 2 to the fraction `part` of the way to t = 12, in steps of 1e-4 of it: more
/// samples than are stored.
template <class F>
std::optional<double> foretold(double part, F f) {
  Pace pace(2.0);
  for (int i = 1; i <= 10000.0 * part; ++i) pace.add(2.0 + 1e-3 * i, f(1e-3 * i));
  return pace.foretell(12.0);
}

TEST(Pace, ExtrapolatesAnEvenCourse) {
  // The sample instants are sums of rounded numbers.
  constexpr double kRounding = 1e-9;
  for (const double part : {0.01, 0.3, 0.99, 1.0})
    EXPECT_NEAR(foretold(part, [](double t) { return 70.0 * t; }).value(), 700.0, kRounding * 700.0) << part;
  // A fast oscillation of the pace by half its mean.
  EXPECT_NEAR(foretold(0.5, [](double t) { return t + 0.5 * std::sin(50.0 * t) / 50.0; }).value(), 10.0, 0.02);
}

TEST(Pace, SaysNothingOfAnUnevenCourse) {
  EXPECT_FALSE(foretold(0.0, [](double t) { return t; }));
  // Pace 1, then 3 from the middle of the trial on; and the reverse.
  const auto kink = [](double from, double to) {
    return foretold(0.34, [=](double t) { return from * t + (to - from) * std::max(0.0, t - 1.7); });
  };
  EXPECT_FALSE(kink(1.0, 3.0));
  EXPECT_FALSE(kink(3.0, 1.0));
  // Continuous slowing, like a wave that spreads.
  EXPECT_FALSE(foretold(0.4, [](double t) { return std::sqrt(t); }));
  // The small remainder cannot change the result much at any pace.
  EXPECT_TRUE(foretold(0.9, [](double t) { return t + std::max(0.0, t - 4.5); }));
}

TEST(Pace, HoldsWithinTheFactorOfItsPieces) {
  // The rest continues at the slowest or the fastest observed pace: the prediction must hold within kUneven
  // if it is given.
  int given = 0;
  for (const double part : {0.34, 0.5, 0.7})
    for (const double ratio : {0.5, 0.8, 0.9, 1.1, 1.25, 2.0}) {
      const double change = 5.0 * part;
      const auto course = [&](double t) { return t + (ratio - 1.0) * std::max(0.0, t - change); };
      const auto value = foretold(part, course);
      if (!value) continue;
      ++given;
      EXPECT_LT(std::max(*value / course(10.0), course(10.0) / *value), Pace::kUneven) << part << " " << ratio;
    }
  EXPECT_GE(given, 12);
}

}  // namespace
}  // namespace butee::test::pace_test

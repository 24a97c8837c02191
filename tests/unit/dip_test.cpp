#include <cmath>

#include <butee/time/dip.hpp>
#include <gtest/gtest.h>

namespace butee::test::dip_test {
namespace {

/// height - cos(t - 0.3) with a second harmonic, so that it is not a parabola: its minimum is height - 1.1,
/// at t = 0.3.
double function(double t, double height) {
  return height - std::cos(t - 0.3) - 0.1 * std::cos(2.0 * (t - 0.3));
}

std::array<time::Look, 3> looks(double height) {
  std::array<time::Look, 3> all;
  for (int i = 0; i < 3; ++i) all[static_cast<std::size_t>(i)] = {-0.8 + i, function(-0.8 + i, height)};
  return all;
}

TEST(Dip, IsMetHoweverShallowItIs) {
  for (const double depth : {5e-3, 1e-4, 1e-6, 1e-9}) {
    const double height = 1.1 - depth;
    const auto at = [height](double t) { return function(t, height); };
    const auto found = time::below_zero(looks(height), at);
    ASSERT_TRUE(found) << depth;
    const auto& [below, before] = *found;
    EXPECT_LT(at(below.t), 0.0) << depth;
    EXPECT_GE(at(before.t), 0.0) << depth;
    EXPECT_LT(before.t, below.t) << depth;
  }
}

TEST(Dip, ThatEndsAboveZeroIsNone) {
  for (const double distance : {0.1, 1e-3, 1e-6, 1e-9}) {
    const double height = 1.1 + distance;
    int calls = 0;
    const auto at = [&](double t) { return ++calls, function(t, height); };
    EXPECT_FALSE(time::below_zero(looks(height), at)) << distance;
    EXPECT_LE(calls, 8) << distance;
  }
}

/// In a step of a few roundings of t the looks coincide in time, and divided differences are not numbers.
TEST(Dip, OfLooksAtOneInstantIsNone) {
  EXPECT_FALSE(time::lowest_of({{{1.0, 2.0}, {1.0, 1.0}, {1.0, 2.0}}}));
  EXPECT_FALSE(time::lowest_of({{{1.0, 2.0}, {1.0, 1.0}, {1.5, 2.0}}}));
  EXPECT_FALSE(time::lowest_of({{{0.5, 2.0}, {1.0, 1.0}, {1.0, 2.0}}}));
  EXPECT_FALSE(time::lowest_of({{{1.0, 1.0}, {1.0, 1.0}, {2.0, 3.0}}}));
}

TEST(Dip, LiesAtTheLowestPointOfAParabola) {
  const auto parabola = [](double t) { return 3.0 * (t - 0.4) * (t - 0.4) + 2.0; };
  const auto lowest = time::lowest_of({{{0.0, parabola(0.0)}, {0.5, parabola(0.5)}, {1.25, parabola(1.25)}}});
  ASSERT_TRUE(lowest);
  EXPECT_NEAR(lowest->t, 0.4, 1e-15);
  EXPECT_NEAR(lowest->value, 2.0, 1e-15);
}

}  // namespace
}  // namespace butee::test::dip_test

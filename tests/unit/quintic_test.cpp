#include "integrators/quintic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace butee::test::quintic_test {
namespace {

using time::State;

State at(double t, double x, double v, double a) {
  return {t, Vector::Constant(1, x), Vector::Constant(1, v), Vector::Constant(1, a), {}, {}};
}

double middle(const State& from, const State& to) {
  double x = 0.0;
  const std::array<Index, 1> dofs = {0};
  integrators::QuinticInterpolant().interpolate(from, to, 0.5 * (from.t + to.t), dofs, {{&x, 1}, {}, {}});
  return x;
}

TEST(Quintic, IsOfOrderSixWhereTheMotionIsSmooth) {
  const auto error = [](double h) {
    const auto state = [](double t) { return at(t, std::sin(t), std::cos(t), -std::sin(t)); };
    return std::abs(middle(state(0.3), state(0.3 + h)) - std::sin(0.3 + 0.5 * h));
  };
  EXPECT_LT(error(0.4), 1e-7);  // the error of the cubic is h^4/384 = 7e-5
  EXPECT_NEAR(std::log2(error(0.4) / error(0.2)), 6.0, 0.3);
}

TEST(Quintic, IsOfItsOrderWhereTheFourthDerivativeVanishes) {
  constexpr double kStep = 0.1;
  const std::array<Index, 1> dofs = {0};
  const auto state = [](double t) { return at(t, std::sin(t), std::cos(t), -std::sin(t)); };
  double worst = 0.0;
  for (int i = -2000; i <= 2000; ++i) {
    const double t = 1e-4 * i;
    for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      double v = 0.0;
      integrators::QuinticInterpolant().interpolate(state(t), state(t + kStep), t + part * kStep, dofs,
                                                    {{}, {&v, 1}, {}});
      worst = std::max(worst, std::abs(v - std::cos(t + part * kStep)));
    }
  }
  // The quintic's error bound is sqrt(5)/30000 h^5; the slope of the cubic has an error of up to h^4/200.
  EXPECT_LT(worst, 1e-4 * std::pow(kStep, 5));
}

TEST(Quintic, IsNotBentByAnEndWithinAStiffStop) {
  // Free flight at 1 m/s that has penetrated 1e-7 m into a stop of 1e14 N/m: -1e7 m/s^2, with a step of 1e-3
  // s.
  const double x = middle(at(0.0, 0.0, 1.0, 0.0), at(1e-3, 1e-3, 1.0, -1e7));
  EXPECT_NEAR(x, 5e-4, 1e-12);
}

TEST(Quintic, IsNotBentByAccelerationsOfAStiffPart) {
  // A light part follows a slow motion at 1 m/s. An error of 1e-9 m with omega = 1e8 rad/s is 1e7 m/s^2.
  const double x = middle(at(0.0, 0.0, 1.0, 1e7), at(1e-3, 1e-3, 1.0, -0.4e7));
  EXPECT_NEAR(x, 5e-4, 1e-12);
  // About an extremum of t^4 or t^6 the accelerations are those of the motion: the quintic, not the cubic (-1, -2).
  EXPECT_NEAR(middle(at(-1.0, 1.0, -4.0, 12.0), at(1.0, 1.0, 4.0, 12.0)), 0.0, 1e-12);
  EXPECT_NEAR(middle(at(-1.0, 1.0, -6.0, 30.0), at(1.0, 1.0, 6.0, 30.0)), 1.0, 1e-12);
}

}  // namespace
}  // namespace butee::test::quintic_test

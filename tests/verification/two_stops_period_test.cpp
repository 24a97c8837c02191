#include <cmath>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::two_stops_period_test {
namespace {

/// Runge-Kutta with steps of h = 2e-6 s, and Newmark with 1e-5 s: a slope discontinuity of the force within a
/// step causes an error of O(h^2), 40 times here. Newmark also lengthens the period by (omega h)^2/12 = 8e-6
/// while in contact.
constexpr double kFixedSteps = 5e-7, kNewmark = 1e-5, kNewmarkEnergy = 1e-4;
/// Step doubling reduces its steps at slope discontinuities: the error follows its tolerance.
constexpr double kAdaptive = 1e-9;

constexpr double kStiffness = 1000.0, kStop = 1e6, kGap = 1e-3, kTotalEnergy = 1e-3;

/// Free motion of a mass between two elastic stops. With A = sqrt(2 E/k), d0 = k g/(k + k_c), A1^2 = 2 E/(k +
/// k_c) - k k_c g^2/(k + k_c)^2:  T = 4 [asin(g/A)/w0 + acos(d0/A1)/w1]. Source: closed form, composed of the
/// two regimes of a piecewise linear oscillator over its four quarters. An independent program confirmed T =
/// 0.1054996060 s.
double closed_form_period() {
  const double sum = kStiffness + kStop, amplitude = std::sqrt(2 * kTotalEnergy / kStiffness);
  const double d0 = kStiffness * kGap / sum;
  const double a1 = std::sqrt(2 * kTotalEnergy / sum - kStiffness * kStop * kGap * kGap / (sum * sum));
  return 4 * (std::asin(kGap / amplitude) / std::sqrt(kStiffness) + std::acos(d0 / a1) / std::sqrt(sum));
}

constexpr const char* kScene = R"(
schema = 1

[[element]]
type = "mass"
name = "ball"
mass = 1.0

[[element]]
type      = "spring"
node      = "ball"
stiffness = 1000.0

[[contact]]
type      = "stop"
nodes     = "ball"
gap       = 1.0e-3
law       = "linear"
stiffness = 1.0e6

[initial]
velocity = [{ nodes = "ball", value = 0.044721359549995794 }]   # sqrt(2 E/m)

[integrator]
type      = "rk4"
time_step = 2.0e-6
end_time  = 1.2

[integrator.newmark]
residual_tolerance  = 1.0e-10
increment_tolerance = 1.0e-10
max_iterations      = 20
)";

TEST(TwoStops, ClosedFormIsTheRecomputedNumber) {
  EXPECT_NEAR(closed_form_period(), 0.1054996060, 5e-11);  // half a unit in the last digit
}

void expect_period(const std::vector<std::string>& overrides, double period_tolerance, double energy_tolerance) {
  constexpr std::size_t kPeriods = 10;
  SceneRun scene(kScene, overrides);
  record::ImpactRecorder recorder(scene.dynamics());
  scene.simulation().add(recorder);
  ASSERT_TRUE(scene.run().completed);
  for (const int side : {1, -1}) {
    std::vector<double> closings;
    for (const record::Impact& impact : recorder.impacts())
      if (impact.side == side) closings.push_back(impact.t_in);
    ASSERT_GT(closings.size(), kPeriods);
    const double period = (closings[kPeriods] - closings[0]) / kPeriods;
    EXPECT_NEAR(period / closed_form_period(), 1.0, period_tolerance) << "side " << side;
  }
  const double energy = record::energy_of(scene.simulation().state(), scene.dynamics()).total();
  EXPECT_NEAR(energy / kTotalEnergy, 1.0, energy_tolerance);
}

TEST(TwoStops, RungeKuttaKeepsThePeriod) {
  expect_period({}, kFixedSteps, kFixedSteps);
}

TEST(TwoStops, RungeKuttaWithSmallStepsAtTheKinksMeetsTheClosedForm) {
  expect_period({"integrator.type=rk4_error_scaled", "integrator.tolerance=1e-13", "integrator.safety=0.9"}, kAdaptive,
                kAdaptive);
}

TEST(TwoStops, NewmarkKeepsThePeriod) {
  expect_period({"integrator.type=newmark", "integrator.time_step=1e-5"}, kNewmark, kNewmarkEnergy);
}

}  // namespace
}  // namespace butee::test::two_stops_period_test

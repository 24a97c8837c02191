#include <cmath>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "verification/turning_points.hpp"

namespace butee::test::thomson_test {
namespace {

/// Tolerance for the closed forms; the published numbers have 5 to 7 digits.
constexpr double kClosedForm = 1e-7;
/// Half a unit in the last printed digit of each number.
constexpr double kTimePrinted = 5e-7, kSpeedPrinted = 5e-4, kPeakPrinted = 5e-7, kPeakTimePrinted = 5e-8;

/// A ball falls on a spring. Source: W. T. Thomson, Vibration Theory and Applications, 2nd printing, 1965,
/// example 4.6-1 (ANSYS VM65), in lbf, in and s. The spring is a one-sided stop, reached after a fall of 1
/// in. Afterwards u = d + m g/k + A cos(w (t - t_peak)) with w = sqrt(k/m) and A^2 = (m g/k)^2 + (v/w)^2.
constexpr const char* kScene = R"(
schema = 1

[[element]]
type = "mass"
name = "ball"
mass = 0.5

[[contact]]
type      = "stop"
nodes     = "ball"
sides     = "positive"
gap       = 1.0
law       = "linear"
stiffness = 1973.92

[[load]]
type  = "constant"
node  = "ball"
value = 193.0      # m g

[integrator]
type      = "rk4"
time_step = 2.0e-6
end_time  = 0.12
)";

TEST(Thomson, BallOnASpring) {
  SceneRun scene(kScene);
  record::ImpactRecorder recorder(scene.dynamics());
  TurningPoints peaks(scene.dof("ball"));
  scene.simulation().add(recorder);
  scene.simulation().add(peaks);
  ASSERT_TRUE(scene.run().completed);
  const auto impacts = recorder.impacts();
  ASSERT_EQ(impacts.size(), 1U);
  ASSERT_EQ(peaks.t.size(), 1U);
  EXPECT_NEAR(impacts[0].t_in, 0.071982, kTimePrinted);
  EXPECT_NEAR(impacts[0].impact_speed, 27.785, kSpeedPrinted);
  EXPECT_NEAR(peaks.x[0], 1.550666, kPeakPrinted);
  EXPECT_NEAR(peaks.t[0], 0.1004449, kPeakTimePrinted);

  const double g = 386.0, k = 1973.92, m = 0.5, w = std::sqrt(k / m), sag = m * g / k;
  const double speed = std::sqrt(2 * g), fall = std::sqrt(2 / g), amplitude = std::hypot(sag, speed / w);
  const double peak_time = fall + (std::acos(-sag / amplitude)) / w;
  EXPECT_NEAR(impacts[0].t_in, fall, kClosedForm * fall);
  EXPECT_NEAR(impacts[0].impact_speed, speed, kClosedForm * speed);
  EXPECT_NEAR(peaks.x[0], 1 + sag + amplitude, kClosedForm);
  EXPECT_NEAR(peaks.t[0], peak_time, kClosedForm * peak_time);
}

}  // namespace
}  // namespace butee::test::thomson_test

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::arctan_energy_test {
namespace {

/// Rounding of the closed form; its terms cancel to a hundredth.
constexpr double kFormula = 1e-12;
/// Runge-Kutta with steps of 1e-5 s: the width 1/(pi lambda) of the law's transition takes 50 steps.
constexpr double kRungeKutta = 1e-9;

constexpr double kGap = 1e-3, kStop = 1e6, kLambda = 1e3;

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
type           = "stop"
nodes          = "ball"
sides          = "positive"
gap            = 1.0e-3
law            = "arctan"
stiffness      = 1.0e6
regularization = 1.0e3

[initial]
velocity = [{ nodes = "ball", value = 0.5 }]

[integrator]
type      = "rk4"
time_step = 1.0e-5
end_time  = 0.5
)";

/// U = k_c [y^2/4 + (1/pi) (y^2/2 atan(s y) - y/(2 s) + atan(s y)/(2 s^2))] + const, y = u - gap, s = pi lambda.
/// Source: the integral of the law of K. L. Nguyen et al., CFM 2017 (hal-03465572), by parts.
double closed_form(double u) {
  const double y = u - kGap, s = std::numbers::pi * kLambda, angle = std::atan(s * y);
  return kStop * (y * y / 4 + (y * y / 2 * angle - y / (2 * s) + angle / (2 * s * s)) / std::numbers::pi);
}

TEST(ArctanEnergy, IsTheClosedFormAndZeroAtRest) {
  SceneRun scene(kScene);
  Vector w(1);
  for (const double u : {0.0, 1e-4, 9e-4, 1e-3, 1.1e-3, 2e-3, 5e-3, -1e-3}) {
    w[0] = u;
    const double expected = closed_form(u) - closed_form(0.0);
    EXPECT_NEAR(scene.dynamics().stops().energy(w), expected, kFormula * closed_form(5e-3)) << u;
  }
}

TEST(ArctanEnergy, IsKeptWithTheRestOverManyImpacts) {
  SceneRun scene(kScene);
  record::ImpactRecorder impacts(scene.dynamics());
  scene.simulation().add(impacts);
  ASSERT_TRUE(scene.run().completed);
  EXPECT_GT(impacts.impacts().size(), 4U);
  const double energy = record::energy_of(scene.simulation().state(), scene.dynamics()).total();
  EXPECT_NEAR(energy / (0.5 * 1.0 * 0.5 * 0.5), 1.0, kRungeKutta);
}

}  // namespace
}  // namespace butee::test::arctan_energy_test

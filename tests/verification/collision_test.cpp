#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "verification/turning_points.hpp"

namespace butee::test::collision_test {
namespace {

/// Steps of h = 1e-6 s: a slope discontinuity of the force within a step causes an error of O((omega h)^2) =
/// 1e-7, twice for each contact. Newmark also lengthens a contact by (omega h)^2/12.
constexpr double kKinks = 1e-6;
/// Momentum is a linear invariant: errors are rounding and Newton's tolerance, over 20 000 steps.
constexpr double kMomentum = 1e-10;

constexpr double kLight = 1.0, kHeavy = 3.0, kStiffness = 1e5, kSpeed = 2.0, kGap = 0.01;

/// A free mass strikes another at rest through an elastic stop between them. Source: conservation of momentum
/// and energy. During contact the relative displacement is half a sine of the reduced mass mu = m1 m2/(m1 +
/// m2), so contact lasts pi sqrt(mu/k) and transfers the impulse 2 mu v.
constexpr const char* kCollision = R"(
schema = 1

[[element]]
type = "mass"
name = "light"
mass = 1.0

[[element]]
type = "mass"
name = "heavy"
mass = 3.0

[[contact]]
type      = "stop"
between   = ["light", "heavy"]
sides     = "positive"
gap       = 0.01
law       = "linear"
stiffness = 1.0e5

[initial]
velocity = [{ nodes = "light", value = 2.0 }]

[integrator]
type      = "rk4"
time_step = 1.0e-6
end_time  = 0.02

[integrator.newmark]
residual_tolerance  = 1.0e-12
increment_tolerance = 1.0e-12
max_iterations      = 20
)";

class Collision : public testing::TestWithParam<const char*> {};

TEST_P(Collision, OfTwoFreeMassesIsThatOfElasticBodies) {
  SceneRun scene(kCollision, {std::string("integrator.type=") + GetParam()});
  record::ImpactRecorder recorder(scene.dynamics());
  scene.simulation().add(recorder);
  ASSERT_TRUE(scene.run().completed);
  const Vector& v = scene.simulation().state().v;
  const double light = v[scene.dof("light")], heavy = v[scene.dof("heavy")];
  EXPECT_NEAR(light, (kLight - kHeavy) / (kLight + kHeavy) * kSpeed, kKinks * kSpeed);
  EXPECT_NEAR(heavy, 2 * kLight / (kLight + kHeavy) * kSpeed, kKinks * kSpeed);
  EXPECT_NEAR(kLight * light + kHeavy * heavy, kLight * kSpeed, kMomentum);

  const auto impacts = recorder.impacts();
  ASSERT_EQ(impacts.size(), 1U);
  const double mu = kLight * kHeavy / (kLight + kHeavy), duration = std::numbers::pi * std::sqrt(mu / kStiffness);
  ASSERT_TRUE(impacts[0].t_out.has_value());
  EXPECT_NEAR(impacts[0].t_in, kGap / kSpeed, kKinks * kGap / kSpeed);
  EXPECT_NEAR((*impacts[0].t_out - impacts[0].t_in) / duration, 1.0, kKinks);
  EXPECT_NEAR(impacts[0].impulse / (2 * mu * kSpeed), 1.0, kKinks);
  EXPECT_NEAR(impacts[0].peak_force / (kSpeed * std::sqrt(mu * kStiffness)), 1.0, kKinks);
  EXPECT_NEAR(impacts[0].impact_speed, kSpeed, kKinks);
}

INSTANTIATE_TEST_SUITE_P(methods, Collision, testing::Values("rk4", "newmark"),
                         [](const auto& instance) { return std::string(instance.param); });

/// A mass bounces on an elastic stop under its weight. Source: closed form, composed of the free fall sqrt(2
/// d/g) and a part of a sine about the static deflection m g/k. The period from release to release is T = 2
/// [sqrt(2 d/g) + acos(-s/A)/w], w = sqrt(k/m), s = m g/k, A^2 = s^2 + (v/w)^2, v^2 = 2 g d.
constexpr const char* kBouncing = R"(
schema = 1

[[element]]
type = "mass"
name = "ball"
mass = 2.0

[[contact]]
type      = "stop"
nodes     = "ball"
sides     = "positive"
gap       = 0.05
law       = "linear"
stiffness = 2.0e5

[[load]]
type  = "constant"
node  = "ball"
value = 19.62      # m g

[integrator]
type      = "rk4"
time_step = 1.0e-5
end_time  = 2.5

[integrator.newmark]
residual_tolerance  = 1.0e-12
increment_tolerance = 1.0e-12
max_iterations      = 20
)";

class Bouncing : public testing::TestWithParam<const char*> {};

TEST_P(Bouncing, PeriodAndDepthAreThoseOfTheClosedForm) {
  // A slope discontinuity of the force within a step changes the energy by a fraction of (omega h)^2 = 1e-5,
  // and the period accordingly.
  constexpr double kPeriodError = 5e-6, kDepthError = 1e-5;
  SceneRun scene(kBouncing, {std::string("integrator.type=") + GetParam()});
  TurningPoints lowest(scene.dof("ball"));
  scene.simulation().add(lowest);
  ASSERT_TRUE(scene.run().completed);
  const double g = 9.81, d = 0.05, w = std::sqrt(2e5 / 2.0), sag = 2.0 * g / 2e5, v = std::sqrt(2 * g * d);
  const double amplitude = std::hypot(sag, v / w);
  const double period = 2 * (std::sqrt(2 * d / g) + std::acos(-sag / amplitude) / w);
  constexpr std::size_t kBounces = 10;
  ASSERT_GT(lowest.t.size(), kBounces);
  EXPECT_NEAR(lowest.t[0] / (0.5 * period), 1.0, kPeriodError);
  EXPECT_NEAR((lowest.t[kBounces] - lowest.t[0]) / kBounces / period, 1.0, kPeriodError);
  for (std::size_t i = 0; i <= kBounces; ++i) EXPECT_NEAR(lowest.x[i], d + sag + amplitude, kDepthError * d);
}

/// A mass thrown at a stop against a constant force closes it at t = 1/2, where `exact` halves its interval.
TEST(Bouncing, BeginsWhereAnIntervalIsHalved) {
  SceneRun scene(R"(
schema = 1
[[element]]
type = "mass"
name = "ball"
mass = 1.0
[[contact]]
type = "stop"
nodes = "ball"
gap = 0.375
sides = "positive"
stiffness = 1e6
[[load]]
type = "constant"
node = "ball"
value = -2.0
[initial]
velocity = [{ nodes = "ball", value = 1.25 }]
[integrator]
type = "exact"
end_time = 1.0
)");
  ASSERT_TRUE(scene.run().completed);
  // Closed at 0.25 m/s, it leaves at that speed after 2 atan(v w/2)/w, under the force -2 N with w = 1000 rad/s.
  const double flight = 0.5 - 2.0 * std::atan(125.0) / 1000.0;
  EXPECT_NEAR(scene.simulation().state().x[scene.dof("ball")], 0.375 - 0.25 * flight - flight * flight, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(methods, Bouncing, testing::Values("rk4", "newmark"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace butee::test::collision_test

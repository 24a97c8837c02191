#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "verification/methods.hpp"

namespace butee::test::steady_state_test {
namespace {

/// At the first sample the free motion has decayed to e^(-0.2 20 6) = 4e-11.
constexpr double kRungeKutta = 1e-7;
/// Newmark lowers the natural frequency by a relative (omega h)^2/24; with omega h up to 0.004 and an
/// amplification of 2 that is 3e-6 of the amplitude. The interpolant's error is smaller.
constexpr double kNewmark = 1e-5;

constexpr double kMass = 2.0, kStiffness = 800.0, kRatio = 0.2, kForce = 6.0, kSpeed = 18.0, kPhase = 0.3;

constexpr const char* kScene = R"(
schema = 1

[[element]]
type = "mass"
name = "ball"
mass = 2.0

[[element]]
type      = "spring"
node      = "ball"
stiffness = 800.0

[damping]
modal = 0.2

[[load]]
type              = "harmonic"
node              = "ball"
amplitude         = 6.0
angular_frequency = 18.0
phase             = 0.3

[integrator]
end_time = 8.0
)";

/// Steady-state vibration x = X cos(w t + phi - delta) with X = (F/k)/sqrt((1 - r^2)^2 + (2 zeta r)^2), tan
/// delta = 2 zeta r/(1 - r^2), r = w/w_0. Source: W. T. Thomson, Theory of Vibration with Applications, 4th
/// ed., section 3.1.
struct SteadyState {
  double r = kSpeed / std::sqrt(kStiffness / kMass);
  double amplitude = kForce / kStiffness / std::hypot(1 - r * r, 2 * kRatio * r);
  double delay = std::atan2(2 * kRatio * r, 1 - r * r);
};

class SteadyVibration : public testing::TestWithParam<Method> {};

TEST_P(SteadyVibration, HasTheAmplitudeAndThePhaseOfTheClosedForm) {
  SceneRun scene(kScene, GetParam().overrides());
  std::vector<double> times;
  for (int i = 0; i <= 400; ++i) times.push_back(6.0 + 0.005 * i);
  Sampler sampler(scene.dof("ball"), times);
  scene.simulation().add(sampler);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;

  // Least-squares fit of x = a cos(w t + phi) + b sin(w t + phi).
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  ASSERT_EQ(sampler.x.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double angle = kSpeed * times[i] + kPhase;
    const Eigen::Vector2d row(std::cos(angle), std::sin(angle));
    normal += row * row.transpose();
    right += sampler.x[i] * row;
  }
  const Eigen::Vector2d ab = normal.inverse() * right;
  const SteadyState exact;
  const double tolerance = GetParam().name.rfind("rk4", 0) == 0 ? kRungeKutta : kNewmark;
  EXPECT_NEAR(ab.norm() / exact.amplitude, 1.0, tolerance);
  EXPECT_NEAR(std::atan2(ab[1], ab[0]), exact.delay, tolerance);
}

INSTANTIATE_TEST_SUITE_P(methods, SteadyVibration, testing::ValuesIn(all_methods()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace butee::test::steady_state_test

#include <cmath>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "verification/methods.hpp"

namespace butee::test::damped_oscillator_test {
namespace {

/// Error of Runge-Kutta, (omega h)^4/120 per radian with omega h = 0.02, or a smaller tolerance: over 40 rad
/// at most 1e-7.
constexpr double kRungeKutta = 2e-7;
/// Newmark lengthens the period by (omega h)^2/12; with omega h = 0.002, the phase error over 40 rad is
/// 1.3e-5 rad. The adaptive methods keep their error estimate within a factor of four of that.
constexpr double kNewmark = 6e-5;

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
damping   = 3.0

[damping]
mass_proportional      = 0.3     # 0.6 N s/m
stiffness_proportional = 5.0e-4  # 0.4 N s/m: with the dashpot 4 N s/m, a ratio of 5 %

[initial]
displacement = [{ nodes = "ball", value = 0.01 }]
velocity     = [{ nodes = "ball", value = 0.3 }]

[integrator]
end_time = 2.0
)";

/// Free vibration x = e^(-zeta w t) [x0 cos(w_d t) + (v0 + zeta w x0)/w_d sin(w_d t)]. Source: W. T. Thomson, Theory of
/// Vibration with Applications, 4th ed., section 2.6.
struct ClosedForm {
  double w = 20.0, zeta = 0.05, x0 = 0.01, v0 = 0.3;

  double x(double t) const {
    const double wd = w * std::sqrt(1 - zeta * zeta), b = (v0 + zeta * w * x0) / wd;
    return std::exp(-zeta * w * t) * (x0 * std::cos(wd * t) + b * std::sin(wd * t));
  }
  double v(double t) const {
    const double wd = w * std::sqrt(1 - zeta * zeta);
    return std::exp(-zeta * w * t) * (v0 * std::cos(wd * t) - (zeta * v0 + w * x0) * w / wd * std::sin(wd * t));
  }
};

class DampedOscillator : public testing::TestWithParam<Method> {};

TEST_P(DampedOscillator, VibratesByTheClosedForm) {
  SceneRun scene(kScene, GetParam().overrides());
  std::vector<double> times, x, v;
  const ClosedForm exact;
  for (int i = 0; i <= 400; ++i) {
    times.push_back(i * 0.005);
    x.push_back(exact.x(times.back()));
    v.push_back(exact.v(times.back()));
  }
  Sampler sampler(scene.dof("ball"), times);
  scene.simulation().add(sampler);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;
  ASSERT_EQ(sampler.x.size(), times.size());
  const double tolerance = GetParam().name.rfind("rk4", 0) == 0 ? kRungeKutta : kNewmark;
  EXPECT_LE(relative_rms(sampler.x, x), tolerance);
  EXPECT_LE(relative_rms(sampler.v, v), tolerance);
}

INSTANTIATE_TEST_SUITE_P(methods, DampedOscillator, testing::ValuesIn(all_methods()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace butee::test::damped_oscillator_test

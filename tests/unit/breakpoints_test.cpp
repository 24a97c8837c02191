#include "integrators/exponential/breakpoints.hpp"

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/exponential/single_mode.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::breakpoints_test {
namespace {

using integrators::Breakpoints;
using integrators::StepForces;

const std::string kScene = mass_on_spring("4.0", R"(
[[contact]]
type = "stop"
nodes = "m"
gap = 0.1
stiffness = 3.0
[[load]]
type = "harmonic"
node = "m"
amplitude = 3.0
angular_frequency = 5.0
)");

double value(const StepForces& forces, double s) {
  return forces.moments[0][0] + (2.0 * s - 1.0) * forces.moments[1][0] +
         (6.0 * s * s - 6.0 * s + 1.0) * forces.moments[2][0];
}

TEST(Breakpoints, FindTheStepOfAnInstant) {
  SceneRun run(kScene);
  Breakpoints points(run.dynamics().modal(0), 4);
  EXPECT_EQ(points.capacity(), 5u);
  const double q = 0.5, v = -0.5, w = 0.25;
  for (const double t : {1.0, 2.0, 4.0, 8.0}) points.add(t, &q, &v, &w);
  EXPECT_EQ(points.steps(), 3u);
  EXPECT_EQ(points.last(), 8.0);
  ASSERT_EQ(points.inner().size(), 2u);
  EXPECT_EQ(points.inner()[0], 2.0);
  EXPECT_EQ(points.inner()[1], 4.0);
  EXPECT_EQ(points.before(1.0), 0u);
  EXPECT_EQ(points.before(2.0), 1u);
  EXPECT_EQ(points.before(7.0), 2u);
  EXPECT_EQ(points.before(8.0), 2u);  // No step begins at the last breakpoint.
  EXPECT_EQ(points.phases(1)[0].cosine, std::cos(10.0));
  points.clear();
  points.add(3.0, &q, &v, &w);
  points.add(5.0, &q, &v, &w);
  EXPECT_EQ(points.phases(1)[0].cosine, std::cos(25.0));
  EXPECT_EQ(points.inner().size(), 0u);
}

TEST(StepForces, DividedAreTheSamePolynomials) {
  StepForces whole, second;
  whole.is_free = false;
  whole.constant.setConstant(1, 0.5);
  for (std::size_t k = 0; k < 3; ++k) whole.moments[k].setConstant(1, 0.3 + 1.1 * static_cast<double>(k));
  whole.touched = {0};
  second.paths = whole.paths = Eigen::ArrayXXd::Zero(1, StepForces::kColumns);
  const integrators::ContactPath path(0.2, 0.7, -0.4, 0.3, 0.05);
  const integrators::ForceMoments force = {1.0, -0.5, 0.25};
  whole.set(0, path, force, 1e-3);
  const Vector w0 = Vector::Constant(1, path.value(0.0)), wm = Vector::Constant(1, path.value(0.25)),
               w1 = Vector::Constant(1, path.value(1.0));
  const auto path_of = [](const StepForces& forces, const Vector& from, const Vector& to) {
    const auto row = forces.paths.row(0);
    return integrators::ContactPath(from[0], row[StepForces::kStartSpeed], to[0], row[StepForces::kEndSpeed],
                                    row[StepForces::kQuartic]);
  };
  const auto force_at = [](const StepForces& forces, double s) {
    const auto row = forces.paths.row(0);
    return row[StepForces::kMoments] + (2.0 * s - 1.0) * row[StepForces::kMoments + 1] +
           (6.0 * s * s - 6.0 * s + 1.0) * row[StepForces::kMoments + 2];
  };
  StepForces first = whole;
  first.divide(0.25, w0, w1, second);
  ASSERT_EQ(first.touched, whole.touched);
  ASSERT_EQ(second.touched, whole.touched);
  for (const double s : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(value(first, s), value(whole, 0.25 * s), 1e-14);
    EXPECT_NEAR(value(second, s), value(whole, 0.25 + 0.75 * s), 1e-14);
    EXPECT_NEAR(path_of(first, w0, wm).value(s), path.value(0.25 * s), 1e-14);
    EXPECT_NEAR(path_of(second, wm, w1).value(s), path.value(0.25 + 0.75 * s), 1e-14);
    EXPECT_NEAR(force_at(first, s), force_at(whole, 0.25 * s), 1e-14);
    EXPECT_NEAR(force_at(second, s), force_at(whole, 0.25 + 0.75 * s), 1e-14);
    EXPECT_EQ(second.paths(0, StepForces::kAllowedSpeed), 1e-3);
  }
  EXPECT_EQ(second.constant[0], 0.5);
}

/// Phases advanced by rotation, recomputed after 32 rotations, and restored from a state in between.
TEST(LoadPhases, AreThoseOfTheTime) {
  SceneRun run(kScene);
  const integrators::SingleMode mode(run.dynamics().modal(0));
  constexpr double kStep = 0.173;
  integrators::LoadPhases phases(mode.harmonics, 100), resumed(mode.harmonics, 100);
  std::vector<double> memory(static_cast<std::size_t>(phases.memory_size()));
  phases.start(memory.data());
  phases.load(2.0, memory.data());
  const auto turn = [&](std::size_t) { return integrators::Phase{std::cos(5.0 * kStep), std::sin(5.0 * kStep)}; };
  for (std::size_t k = 1; k <= 100; ++k) {
    const double t = 2.0 + kStep * static_cast<double>(k);
    phases.turn(k, t, turn);
    EXPECT_NEAR(phases.at(k)[0].cosine, std::cos(5.0 * t), 3e-14) << k;
    EXPECT_NEAR(phases.at(k)[0].sine, std::sin(5.0 * t), 3e-14) << k;
    if (k == 20) {
      phases.save(k, memory.data());
      resumed.load(t, memory.data());
    }
    if (k <= 20) continue;
    resumed.turn(k - 20, t, turn);
    EXPECT_EQ(resumed.at(k - 20)[0].cosine, phases.at(k)[0].cosine) << k;  // bitwise equal
    EXPECT_EQ(resumed.at(k - 20)[0].sine, phases.at(k)[0].sine) << k;
  }
}

}  // namespace
}  // namespace butee::test::breakpoints_test

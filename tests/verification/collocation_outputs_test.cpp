// Outputs and peaks of exponential on coupled modes, compared with the closed form of piecewise.
#include <cmath>
#include <string>

#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::collocation_outputs_test {
namespace {

/// A light mass between two others, driven at a frequency above those of the slow modes; the collocation
/// makes no approximation.
const std::string kLight = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 0.7
[[element]]
type = "spring"
node = "a"
stiffness = 2000.0
damping = 2.4
[[element]]
type = "mass"
name = "light"
mass = 3e-5
[[element]]
type = "spring"
nodes = ["a", "light"]
stiffness = 7.0
damping = 0.006
[[element]]
type = "mass"
name = "b"
mass = 1.4
[[element]]
type = "spring"
nodes = ["light", "b"]
stiffness = 1400.0
[[load]]
node = "a"
type = "harmonic"
amplitude = 15.0
angular_frequency = 97.0
[[load]]
node = "light"
type = "harmonic"
amplitude = 32.0
angular_frequency = 65.0
phase = -1.5
[initial]
displacement = [{ nodes = "b", dof = "u", value = 0.013 }]
[integrator]
end_time = 0.2
)";

/// A light mass behind dashpots, pushed by a slow ramp: its mode decays at 1.6e7 1/s and rests on the ramp, where its
/// acceleration is rounding. Resolving that took 0.05 s a step; steps beyond the limit of breakpoints were tried in
/// vain.
TEST(CollocationOutputs, DoNotShortenStepsForModesThatRest) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "body"
mass = 0.4
[[element]]
type = "spring"
node = "body"
stiffness = 0.6
damping = 0.05
[[element]]
type = "mass"
name = "part"
mass = 3.5e-4
[[element]]
type = "spring"
nodes = ["body", "part"]
stiffness = 0.0
damping = 0.7
[[element]]
type = "mass"
name = "light"
mass = 4.5e-7
[[element]]
type = "spring"
nodes = ["part", "light"]
stiffness = 0.0
damping = 7.3
[[load]]
node = "light"
type = "ramp"
from = 1.0
to = -1.0
start = 100.0
end = 190.0
[initial]
velocity = [{ nodes = "body", value = 1.0 }]
[integrator]
tolerance = 1e-6
end_time = 102.0
)";
  SceneRun run(scene, {"integrator.type=exponential"}), other(scene, {"integrator.type=rodas4"});
  for (SceneRun* one : {&run, &other}) ASSERT_TRUE(one->run().completed) << one->simulation().report().message;
  EXPECT_LT(run.simulation().report().steps, 100);
  EXPECT_LT(run.simulation().report().rejected, 5);
  const Vector &got = run.simulation().state().x, &wanted = other.simulation().state().x;
  EXPECT_LT((got - wanted).lpNorm<Eigen::Infinity>(), 1e-5 * wanted.lpNorm<Eigen::Infinity>());
}

/// A light mass that moves at the start behind a dashpot decays at 2e5 and 6e6 1/s, from which the first step cannot
/// reach its end: 4e7 breakpoints took 20 s. The limit must be known in the first step, before the scales of its end
/// are those of another step.
TEST(CollocationOutputs, ShortenTheFirstStepForALightMass) {
  SceneRun run(R"(
schema = 1
[[element]]
type = "mass"
name = "body"
mass = 4.7
[[element]]
type = "mass"
name = "light"
mass = 1.7e-6
[[element]]
type = "spring"
nodes = ["body", "light"]
stiffness = 2e6
damping = 10.3
[[element]]
type = "spring"
node = "light"
stiffness = 0.076
[initial]
velocity = [{ nodes = "light", value = 0.1 }]
[integrator]
type = "exponential"
tolerance = 1e-4
end_time = 7.0
)");
  ASSERT_TRUE(run.simulation().advance());
  const double first = run.simulation().state().t;
  EXPECT_LT(first, 4096 * 1.5 / 5.9e6);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_LT(run.simulation().report().steps, 50);
}

/// Modes that follow a load have large amplitudes, but do not turn: they need no nodes. With |z| in place of their
/// distance from the place where they would rest the steps resolved the highest modes, 16 583 steps instead of 557.
TEST(CollocationOutputs, DoNotShortenStepsForModesThatFollowALoad) {
  const std::string scene = R"(schema = 1
[material.s]
young_modulus = 7e10
density = 2700
[section.r]
shape = "rectangle"
width = 0.02
height = 0.006
[[element]]
type = "beam"
name = "b"
material = "s"
section = "r"
length = 1.0
elements = 20
[[element]]
type = "mass"
name = "m"
mass = 0.1
[[element]]
type = "spring"
nodes = ["m", "b:15"]
stiffness = 100.0
damping = 0.5
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "b:10"
gap = 2e-3
law = "linear"
stiffness = 1e5
[[load]]
node = "b:5"
dof = "theta"
type = "constant"
value = 3.0
[damping]
mass_proportional = 2.0
stiffness_proportional = 2e-5
[integrator]
end_time = 0.3
)";
  SceneRun run(scene, {"integrator.type=exponential", "integrator.tolerance=1e-4"}),
      other(scene, {"integrator.type=rodas4", "integrator.tolerance=1e-6"});
  for (SceneRun* one : {&run, &other}) ASSERT_TRUE(one->run().completed) << one->simulation().report().message;
  EXPECT_LT(run.simulation().report().steps, 1500);
  const Vector &got = run.simulation().state().x, &wanted = other.simulation().state().x;
  EXPECT_LT((got - wanted).lpNorm<Eigen::Infinity>(), 1e-4 * wanted.lpNorm<Eigen::Infinity>());
}

/// Steps are longer than the periods of the light mass and of the loads.
TEST(CollocationOutputs, GiveValuesAndPeaksOfFastMotion) {
  std::vector<double> times;
  for (int i = 1; i < 100; ++i) times.push_back(0.00199 * i);
  SceneRun closed(kLight, {"integrator.type=piecewise"}),
      run(kLight, {"integrator.type=exponential", "integrator.tolerance=1e-8"});
  Sampler wanted(closed.dof("b"), times), got(run.dof("b"), times);
  closed.simulation().add(wanted);
  run.simulation().add(got);
  const auto peaks_of = [](SceneRun& scene) {
    model::OutputRequest request;
    request.interval = 0.1;
    request.probes = {{"p",
                       scene.model().nodes.select("light").nodes.front(),
                       {model::Quantity::u, model::Quantity::v, model::Quantity::a},
                       ""}};
    return std::make_unique<record::HistoryRecorder>(request, 0.2, scene.dynamics(), nullptr);
  };
  const auto wanted_peaks = peaks_of(closed), got_peaks = peaks_of(run);
  closed.simulation().add(*wanted_peaks);
  run.simulation().add(*got_peaks);
  ASSERT_TRUE(closed.run().completed);
  ASSERT_TRUE(run.run().completed);
  EXPECT_LT(run.simulation().report().steps, 30);
  double size_x = 0.0, size_v = 0.0;
  for (const double x : wanted.x) size_x = std::max(size_x, std::abs(x));
  for (const double v : wanted.v) size_v = std::max(size_v, std::abs(v));
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(got.x[i], wanted.x[i], 1e-7 * size_x) << times[i];
    EXPECT_NEAR(got.v[i], wanted.v[i], 1e-7 * size_v) << times[i];
  }
  ASSERT_EQ(wanted_peaks->peaks().size(), 3u);
  for (const auto& [column, peak] : wanted_peaks->peaks())
    EXPECT_NEAR(got_peaks->peaks().at(column), peak, 1e-7 * peak) << column;
}

/// Impulses are integrated between the instants of opening and closing, on the polynomials between breakpoints.
TEST(CollocationOutputs, GiveImpactsOfFastMotion) {
  const std::string scene = kLight + R"(
[[contact]]
type = "stop"
nodes = "b"
gap = 0.01
law = "linear"
stiffness = 2e5
)";
  SceneRun closed(scene, {"integrator.type=piecewise"}),
      run(scene, {"integrator.type=exponential", "integrator.tolerance=1e-6"});
  record::ImpactRecorder wanted(closed.dynamics()), got(run.dynamics());
  closed.simulation().add(wanted);
  run.simulation().add(got);
  ASSERT_TRUE(closed.run().completed);
  ASSERT_TRUE(run.run().completed);
  ASSERT_GT(wanted.impacts().size(), 2u);
  ASSERT_EQ(got.impacts().size(), wanted.impacts().size());
  for (std::size_t i = 0; i < wanted.impacts().size(); ++i) {
    const record::Impact expected = wanted.impacts()[i], found = got.impacts()[i];
    EXPECT_NEAR(found.t_in, expected.t_in, 1e-8) << i;
    EXPECT_NEAR(found.impulse, expected.impulse, 1e-5 * expected.impulse) << i;
    EXPECT_NEAR(found.peak_force, expected.peak_force, 1e-5 * expected.peak_force) << i;
  }
}

}  // namespace
}  // namespace butee::test::collocation_outputs_test

// Beams of many short elements: element forces are far larger than their sums, so that rounding of the residual exceeds
// Newton's tolerances.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::fine_mesh_test {
namespace {

constexpr const char* kBeam = R"(
schema = 1
[material.steel]
young_modulus = 2.0e11
density = 7800.0
[section.tube]
shape = "tube"
outer_radius = 0.05
inner_radius = 0.04
[[element]]
type = "beam"
name = "a"
material = "steel"
section = "tube"
length = 9.0
elements = 300
[[support]]
nodes = ["a:first", "a:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "a:50"
gap = 4e-4
law = "linear"
stiffness = 5e6
[[load]]
type = "harmonic"
node = "a:100"
amplitude = 3000.0
angular_frequency = 60.0
[integrator]
end_time = 0.03
)";

class FineMesh : public testing::TestWithParam<std::string> {};

TEST_P(FineMesh, NewtonConvergesToRounding) {
  SceneRun reference(kBeam, {"integrator.type=exponential", "integrator.tolerance=1e-6"});
  ASSERT_TRUE(reference.run().completed) << reference.simulation().report().message;
  SceneRun beam(kBeam, {"integrator.type=" + GetParam(), "integrator.time_step=2e-5"});
  const time::RunReport& report = beam.run();
  ASSERT_TRUE(report.completed) << report.message;
  // The method's error with some 20 steps in an impact.
  const Index middle = beam.dof("a:150");
  const double expected = reference.simulation().state().x[middle];
  EXPECT_NEAR(beam.simulation().state().x[middle], expected, 5e-3 * std::abs(expected));
  EXPECT_LT(report.newton_iterations, 5 * report.steps);
}

INSTANTIATE_TEST_SUITE_P(Methods, FineMesh,
                         testing::Values("newmark", "generalized_alpha", "hht_alpha", "bathe", "discrete_gradient"));

}  // namespace
}  // namespace butee::test::fine_mesh_test

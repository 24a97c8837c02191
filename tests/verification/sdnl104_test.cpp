#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::sdnl104_test {
namespace {

/// The published numbers have 6 digits.
constexpr double kPrinted = 5e-6;

/// A cantilever pressed against an elastic stop by a step force at its tip. Source: the validation case
/// SDNL104 of code_aster, computed with Newmark (1/4, 1/2) and Newton at h = 1e-4 s. The numbers are those of
/// that scheme at that step, not converged ones; an independent program recomputed them.
constexpr const char* kScene = R"(
schema = 1

[material.heavy]
young_modulus = 1.0e10
density       = 1.0e6

[section.bar]
shape  = "circle"
radius = 0.1

[[element]]
type     = "beam"
name     = "arm"
material = "heavy"
section  = "bar"
length   = 1.0
elements = 10

[[support]]
nodes = "arm:first"
fix   = ["u", "theta"]

[[contact]]
type      = "stop"
nodes     = "arm:last"
sides     = "negative"
gap       = 1.0e-4
law       = "linear"
stiffness = 1.0e8

[[load]]
type  = "constant"
node  = "arm:last"
value = -1000.0

[integrator]
type                = "newmark"
time_step           = 1.0e-4
end_time            = 0.16
residual_tolerance  = 1.0e-10
increment_tolerance = 1.0e-10
max_iterations      = 20
)";

TEST(Sdnl104, TipAndKineticEnergyAreThoseOfTheSameScheme) {
  SceneRun scene(kScene);
  Sampler tip(scene.dof("arm:last"), {0.1315, 0.1566});
  scene.simulation().add(tip);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;
  EXPECT_EQ(report.steps, 1600);
  ASSERT_EQ(tip.x.size(), 2U);
  EXPECT_NEAR(tip.x[0] / -1.85334e-6, 1.0, kPrinted);
  EXPECT_NEAR(tip.v[1] / -4.63284e-3, 1.0, kPrinted);
  EXPECT_NEAR(record::energy_of(scene.simulation().state(), scene.dynamics()).kinetic / 5.14081e-2, 1.0, kPrinted);
}

}  // namespace
}  // namespace butee::test::sdnl104_test

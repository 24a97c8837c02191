// Contacts that are too far away to act cost nothing.
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::far_contact_test {
namespace {

/// A rotating pipe struck at its middle; its fast modes turn hundreds of times in a step.
const std::string kPipe = R"(
schema = 1
[material.steel]
young_modulus = 2.03e11
density = 7900.0
[section.pipe]
shape = "tube"
outer_radius = 0.06
inner_radius = 0.04
[rotation]
speed = 20.0
[[element]]
type = "beam"
theory = "rayleigh"
material = "steel"
section = "pipe"
name = "pipe"
motion = "lateral"
length = 20.0
elements = 12
[[support]]
nodes = ["pipe:first", "pipe:last"]
fix = ["uy", "uz"]
[[load]]
type = "unbalance"
node = "pipe:middle"
moment = 0.5
[initial]
velocity = [{ nodes = "pipe:middle", dof = "uy", value = 0.1 }]
[damping]
mass_proportional = 0.03
[integrator]
type = "exponential"
tolerance = 1e-8
end_time = 0.2
)";

std::string rings(const char* gap) {
  return kPipe + "[[contact]]\ntype = \"ring\"\nnodes = \"pipe:all\"\nstiffness = 1e6\ngap = " + gap + "\n";
}

TEST(FarContact, LeavesTheStepsAsTheyAre) {
  SceneRun alone(kPipe), far(rings("50.0"));
  const time::RunReport free = alone.run();
  ASSERT_TRUE(free.completed) << free.message;
  const time::RunReport& with = far.run();
  ASSERT_TRUE(with.completed) << with.message;
  // 9 and 3 steps; 362 if the path of the far contact were resolved.
  EXPECT_LE(with.steps, free.steps + 20);
  const Vector& wanted = alone.simulation().state().x;
  EXPECT_LT((far.simulation().state().x - wanted).norm(), 1e-9 * wanted.norm());
}

/// The same rings within reach: their contacts are found from far away.
TEST(FarContact, IsFoundOnceItIsNear) {
  SceneRun run(rings("2e-3")), other(rings("2e-3"), {"integrator.type=dopri5", "integrator.tolerance=1e-7"}),
      alone(kPipe);
  for (SceneRun* one : {&run, &other, &alone}) ASSERT_TRUE(one->run().completed) << one->simulation().report().message;
  const Vector& wanted = other.simulation().state().x;
  EXPECT_LT((run.simulation().state().x - wanted).norm(), 1e-6 * wanted.norm());
  EXPECT_GT((alone.simulation().state().x - wanted).norm(), 0.1 * wanted.norm());
}

}  // namespace
}  // namespace butee::test::far_contact_test

// exponential on coupled structures and contacts in the plane, compared with exact (Taylor series, every
// change located).
#include <cmath>

#include <gtest/gtest.h>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::collocation_test {
namespace {

/// A rotating pipe with gyroscopic terms that rubs on rings.
const std::string kPipe = TurningPipe{"b", "lateral", "20.0", 8, "0.004", "0.05", "1.0"}.scene(R"(
[damping]
mass_proportional = 0.5
[integrator]
end_time = 0.6
)");

/// A planar beam with a dashpot, a table load and stops on both sides.
const std::string kBeam = R"(
schema = 1
[material.steel]
young_modulus = 2.03e11
density = 7900.0
[section.pipe]
shape = "tube"
outer_radius = 0.06
inner_radius = 0.04
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "pipe"
length = 20.0
elements = 8
[[element]]
type = "spring"
node = "b:3"
stiffness = 10.0
damping = 300.0
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "b:all"
gap = 0.004
stiffness = 1e6
[[load]]
type = "table"
node = "b:middle"
times = [0.0, 0.11, 0.35, 0.6]
values = [0.0, 900.0, -700.0, 100.0]
[integrator]
end_time = 0.6
)";

/// Two bodies without connection to ground, joined by a dashpot; one of them strikes dissipative planes.
const std::string kFlight = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "mass"
name = "b"
mass = 2.0
[[element]]
type = "spring"
nodes = ["a", "b"]
dof = "uy"
stiffness = 500.0
damping = 2.0
[[element]]
type = "spring"
nodes = ["a", "b"]
dof = "uz"
stiffness = 500.0
damping = 2.0
[[contact]]
type = "plane"
nodes = "a"
normal = [1.0, 0.3]
gap = 0.05
stiffness = 1e5
damping = { type = "hunt_crossley", restitution = 0.7, impact_speed = 1.0 }
friction = { coefficient = 0.1, slip_speed = 0.05 }
[initial]
velocity = [{ nodes = "a", dof = "uy", value = 1.0 }, { nodes = "b", dof = "uy", value = 0.8 }]
[integrator]
end_time = 0.4
)";

/// At rest: a body pressed into a ring, and another one held by friction until a load has grown.
const std::string kRest = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "spring"
node = "a"
dof = "uy"
stiffness = 400.0
damping = 1.0
[[element]]
type = "spring"
node = "a"
dof = "uz"
stiffness = 500.0
damping = 1.0
[[element]]
type = "mass"
name = "b"
mass = 1.0
[[element]]
type = "spring"
nodes = ["a", "b"]
dof = "uy"
stiffness = 100.0
[[element]]
type = "spring"
node = "b"
dof = "uz"
stiffness = 100.0
[[contact]]
type = "ring"
nodes = "a"
gap = 0.01
stiffness = 1e5
friction = { coefficient = 0.2, slip_speed = 0.05 }
[[contact]]
type = "friction"
nodes = "b"
dof = "uy"
normal_force = 5.0
friction = { coefficient = 0.3, slip_speed = 0.05 }
[[load]]
type = "ramp"
node = "b"
dof = "uy"
from = 0.0
to = 4.0
start = 0.1
end = 0.4
[initial]
displacement = [{ nodes = "a", dof = "uy", value = 0.012 }]
[integrator]
end_time = 0.6
)";

/// A mass at rest on a spring and on its ring, in equilibrium with its load to the last digit.
const std::string kBalance = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "spring"
node = "a"
dof = "uy"
stiffness = 128.0
[[element]]
type = "spring"
node = "a"
dof = "uz"
stiffness = 128.0
[[contact]]
type = "ring"
nodes = "a"
gap = 0.5
stiffness = 64.0
[[load]]
type = "constant"
node = "a"
dof = "uy"
value = 80.0
[initial]
displacement = [{ nodes = "a", dof = "uy", value = 0.58333333333333333 }]
[integrator]
type = "exponential"
end_time = 1.0
)";

std::string replaced(std::string scene, const std::string& from, const std::string& to) {
  const std::size_t place = scene.find(from);
  return place == std::string::npos ? "" : scene.replace(place, from.size(), to);
}

/// The beam with a regularised law: a transition of 0.05 mm, which takes steps of its own, and a force of each open
/// stop that jumps in the middle of the gap.
const std::string kRegularised =
    replaced(kBeam, "stiffness = 1e6", "stiffness = 1e6\nlaw = \"arctan\"\nregularization = 2e4");

/// The pipe with stick springs: their tension depends on where they took hold.
const std::string kSticking = replaced(kPipe, "slip_speed = 0.05", "stick_stiffness = 2e5");

/// The pipe, run up from a quarter of its speed; the modes are those of another speed than that of any step.
const std::string kRunUp =
    replaced(kPipe, "speed = 30.0", "speed = { type = \"ramp\", from = 10.0, to = 45.0, end = 0.5 }");

/// Two bodies at rest, one of them in the middle of a gap, where the force of its stop jumps.
const std::string kInTheMiddle = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "mass"
name = "b"
mass = 1.0
[[element]]
type = "spring"
nodes = ["a", "b"]
stiffness = 500.0
damping = 0.3
[[contact]]
type = "stop"
nodes = "a"
gap = 0.01
stiffness = 5e3
law = "arctan"
regularization = 3e4
)";

class CoupledScenes : public testing::TestWithParam<std::string> {};

double distance(const time::State& a, const time::State& b) {
  return std::max((a.x - b.x).norm() / b.x.norm(), (a.v - b.v).norm() / b.v.norm());
}

/// Disturbances grow at most 30 times in these scenes (measured by exact from a start displaced by a relative
/// 1e-6).
TEST_P(CoupledScenes, MeetExactTheNearerTheSmallerTheTolerance) {
  SceneRun exact(GetParam(), {"integrator.type=exact"});
  ASSERT_TRUE(exact.run().completed) << exact.simulation().report().message;
  const time::State& wanted = exact.simulation().state();
  std::vector<double> errors;
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    SceneRun run(GetParam(),
                 {"integrator.type=exponential", "integrator.tolerance=" + std::to_string(tolerance * 1e7) + "e-7"});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    errors.push_back(distance(run.simulation().state(), wanted));
    EXPECT_LT(errors.back(), 30.0 * tolerance) << tolerance;
  }
  EXPECT_LT(errors[2], std::max(1e-2 * errors[0], 10.0 * 1e-7));
}

/// The result of a step depends only on the state.
TEST_P(CoupledScenes, GoOnFromAStateWithTheSameBits) {
  SceneRun run(GetParam(), {"integrator.type=exponential"}), other(GetParam(), {"integrator.type=exponential"});
  time::State from, to, again;
  from.x = run.system().initial_displacement;
  from.v = run.system().initial_velocity;
  time::State twin = from;
  run.integrator().start(from);
  other.integrator().start(twin);
  double h = 1e-3;
  for (int k = 0; k < 40; ++k) {
    run.integrator().settle(from, h);
    const auto report = run.integrator().step(from, {h, from.t + h, true}, to);
    ASSERT_EQ(report.status, time::StepStatus::ok);
    // The other integrator has not seen the previous steps.
    other.integrator().settle(from, h);
    other.integrator().step(from, {h, from.t + h, true}, again);
    EXPECT_TRUE(again.x == to.x && again.v == to.v && again.t == to.t && again.memory == to.memory);
    if (report.error <= 1.0) std::swap(from, to);
    h = report.error <= 1.0 ? 1e-3 : 0.5 * h;
  }
}

/// Outputs are independent of the steps: the closed form within a step equals the end of shorter steps.
TEST_P(CoupledScenes, HaveTheSameOutputsForAnySteps) {
  const std::vector<double> times = {0.0313, 0.1002, 0.177, 0.2811, 0.33};
  SceneRun exact(GetParam(), {"integrator.type=exact"}),
      run(GetParam(), {"integrator.type=exponential", "integrator.tolerance=1e-8"});
  Sampler wanted(0, times), got(0, times);
  exact.simulation().add(wanted);
  run.simulation().add(got);
  ASSERT_TRUE(exact.run().completed);
  ASSERT_TRUE(run.run().completed);
  double size_x = 0.0, size_v = 0.0;
  for (const double x : wanted.x) size_x = std::max(size_x, std::abs(x));
  for (const double v : wanted.v) size_v = std::max(size_v, std::abs(v));
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(got.x[i], wanted.x[i], 1e-6 * size_x) << times[i];
    EXPECT_NEAR(got.v[i], wanted.v[i], 1e-6 * size_v) << times[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Collocation, CoupledScenes,
                         testing::Values(kPipe, kBeam, kFlight, kRest, kRegularised, kSticking, kRunUp));

TEST(Collocation, StaysInEquilibrium) {
  // Equilibrium: 128 x + 64 (x - 1/2) = 80
  SceneRun run(kBalance);
  const double begin = run.system().initial_displacement[0];
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_NEAR(run.simulation().state().x[0], begin, 1e-12);
  EXPECT_LT(run.simulation().report().steps, 1000);
}

/// A mass on a belt strikes a stop. Its velocity passes that of the belt while the stop is closed, so that a friction
/// of 0.4 N reverses beside a stop force of 190 N.
TEST(Collocation, SeesFrictionThatReversesBesideAStop) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[element]]
type = "spring"
node = "m"
stiffness = 3340.0
damping = 0.86
[[load]]
node = "m"
type = "harmonic"
amplitude = 14.3
angular_frequency = 21.9
phase = -0.095
[[contact]]
type = "friction"
nodes = "m"
normal_force = 5.2
friction = { coefficient = 0.08, slip_speed = 0.014, smoothing = "tanh", surface_speed = 0.145 }
[[contact]]
type = "stop"
nodes = "m"
sides = "negative"
gap = 0.00078
stiffness = 176000.0
[integrator]
end_time = 0.125
)";
  SceneRun exact(scene, {"integrator.type=exact"});
  ASSERT_TRUE(exact.run().completed) << exact.simulation().report().message;
  for (double tolerance = 1e-4; tolerance > 1e-6; tolerance *= 0.8) {
    SceneRun run(scene, {"integrator.type=exponential", "integrator.tolerance=" + to_text(tolerance)});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_LT(distance(run.simulation().state(), exact.simulation().state()), 10.0 * tolerance) << tolerance;
  }
}

/// At rest in the middle no side is the right one, until a load moves the body.
TEST(Collocation, RestsInTheMiddleOfAGapUntilALoadActs) {
  const std::string scene = kInTheMiddle + R"([[load]]
type = "ramp"
node = "b"
to = 3.0
start = 0.01
end = 0.02
[integrator]
end_time = 0.05
)";
  SceneRun exact(scene, {"integrator.type=exact"}), run(scene, {"integrator.type=exponential"});
  ASSERT_TRUE(exact.run().completed);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_GT(exact.simulation().state().x[1], 1e-4);
  EXPECT_LT(distance(run.simulation().state(), exact.simulation().state()), 1e-3);
}

/// A mass without gyroscopic terms: only the force of the unbalance varies with the speed.
TEST(Collocation, FollowsAnUnbalanceThatRunsUp) {
  const std::string scene = R"(
schema = 1
[rotation]
speed = { type = "ramp", from = 0.0, to = 60.0, start = 0.1, end = 1.0 }
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[element]]
type = "spring"
node = "m"
dof = "uy"
stiffness = 1800.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 2000.0
[[load]]
type = "unbalance"
node = "m"
moment = 0.01
[integrator]
end_time = 1.2
)";
  SceneRun exact(scene, {"integrator.type=exact"});
  ASSERT_TRUE(exact.run().completed);
  for (const char* tolerance : {"1e-3", "1e-5", "1e-7"}) {
    SceneRun run(scene, {"integrator.type=exponential", std::string("integrator.tolerance=") + tolerance});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_LT(distance(run.simulation().state(), exact.simulation().state()), 10.0 * std::stod(tolerance));
    EXPECT_LT(run.simulation().report().steps, 3000);
  }
}

/// In the middle of a gap the force jumps by 1 % of the acceleration. A load on the other body alone would move body a
/// to the positive side; the pull of a blunt stop of 1.7 N moves it to the negative one.
TEST(Collocation, LeavesTheMiddleOfAGapToTheSideOfItsMotion) {
  const std::string scene = kInTheMiddle + R"([[contact]]
type = "stop"
nodes = "a"
sides = "negative"
gap = 0.01
stiffness = 1e4
law = "arctan"
regularization = 600.0
[[load]]
type = "constant"
node = "b"
value = 3.0
[integrator]
end_time = 0.004
)";
  SceneRun exact(scene, {"integrator.type=exact"}),
      run(scene, {"integrator.type=exponential", "integrator.tolerance=1e-7"});
  ASSERT_TRUE(exact.run().completed);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double wanted = exact.simulation().state().v[0];
  EXPECT_LT(wanted, 0.0);
  EXPECT_NEAR(run.simulation().state().v[0] / wanted, 1.0, 1e-5);
}

/// The forces of `hertz` begin with the power 3/2 of the penetration. The reference is another method.
TEST(Collocation, TakesContactsOfCurvedBodies) {
  const std::string hertz = "law = \"hertz\"\nstiffness = 2e7";
  for (const std::string& scene :
       {replaced(kPipe, "stiffness = 1e6", hertz), replaced(kBeam, "stiffness = 1e6", hertz)}) {
    ASSERT_FALSE(scene.empty());
    SceneRun reference(scene, {"integrator.type=extrapolation8", "integrator.tolerance=1e-9"});
    ASSERT_TRUE(reference.run().completed) << reference.simulation().report().message;
    for (const char* tolerance : {"1e-3", "1e-5", "1e-7"}) {
      SceneRun run(scene, {"integrator.type=exponential", std::string("integrator.tolerance=") + tolerance});
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_LT(distance(run.simulation().state(), reference.simulation().state()), 30.0 * std::stod(tolerance));
    }
  }
}

std::string complaint(const std::string& toml) {
  try {
    SceneRun run(toml, {"integrator.type=exponential"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Collocation, RefusesRigidStickAndNamesTheOthers) {
  std::string rigid = kFlight;
  rigid.replace(rigid.find("slip_speed = 0.05"), 17, "stick = \"rigid\"");
  const std::string message = complaint(rigid);
  EXPECT_NE(message.find("exact"), std::string::npos) << message;
}

TEST(Collocation, RefusesRingsWhoseLawActsWhileTheyAreApart) {
  const std::string message =
      complaint(replaced(kRest, "stiffness = 1e5", "stiffness = 1e5\nlaw = \"arctan\"\nregularization = 1e6"));
  EXPECT_NE(message.find("acts while the contact is apart"), std::string::npos) << message;
  EXPECT_NE(message.find("rodas4"), std::string::npos) << message;
}

}  // namespace
}  // namespace butee::test::collocation_test

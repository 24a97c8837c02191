// Structures that rest in a static position on closed contacts: no method follows vibrations of rounding, and a load
// that begins later is followed as from any other start.
#include <cmath>

#include <butee/core/error.hpp>
#include <butee/dynamics/frequencies.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::at_rest_test {
namespace {

/// Steps of a second in which nothing happens: L-stable methods take about 10, explicit ones hundreds, at their limit
/// of stability. Vibrations of rounding would take thousands.
constexpr std::int64_t kFew = 600;

std::string pressed_mass(const std::string& contact, const std::string& more = "") {
  return R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e4
damping = 1.0
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[integrator]
type = "rodas4"
end_time = 1.0
[[contact]]
nodes = "m"
gap = 1e-4
)" + contact +
         more;
}

const std::string kStop = "type = \"stop\"\nlaw = \"linear\"\nstiffness = 3e4\n";
const std::string kRing = R"(type = "ring"
law = "linear"
stiffness = 3e4
friction = { coefficient = 0.2, slip_speed = 1e-3 }
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 1e4
)";
const std::string kHertz =
    "type = \"stop\"\nlaw = \"hertz\"\nstiffness = 1e7\ndamping = { type = \"hunt_crossley\", factor = 0.5 }\n";

void expect_rest(const std::string& scene, const std::string& method, std::int64_t most = kFew) {
  SceneRun run(scene, {"integrator.type=" + method});
  const Vector start = run.system().initial_displacement;
  const auto& report = run.run();
  EXPECT_TRUE(report.completed) << method << report.message;
  EXPECT_LT(report.steps + report.rejected, most) << method << " " << report.steps << " " << report.rejected;
  EXPECT_LT((run.simulation().state().x - start).norm(), 1e-9 * start.norm()) << method;
}

TEST(AtRest, EveryAdaptiveMethodTakesFewSteps) {
  for (const char* method : {"auto", "rodas4", "dopri5", "extrapolation8", "exponential", "bathe_adaptive",
                             "generalized_alpha_adaptive", "hht_alpha_adaptive"})
    expect_rest(pressed_mass(kStop), method);
  for (const char* method : {"auto", "rodas4", "dopri5", "extrapolation8", "exponential"})
    expect_rest(pressed_mass(kRing), method);
  for (const char* method : {"auto", "rodas4", "dopri5", "extrapolation8"}) expect_rest(pressed_mass(kHertz), method);
}

/// Steps at rest are not judged. Explicit methods keep within their limits of stability all the same: beyond them
/// vibrations of rounding grew to 1e-10 of the highest frequency times the sag.
TEST(AtRest, ExplicitMethodsDoNotLetRoundingGrow) {
  for (const char* damping : {"0.0", "1e-5"}) {
    const std::string scene = R"(
schema = 1
[material.m]
young_modulus = 2.1e11
density = 7850.0
[section.s]
shape = "circle"
radius = 0.05
[[element]]
type = "beam"
name = "b"
material = "m"
section = "s"
length = 12.0
elements = 20
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[integrator]
type = "dopri5"
end_time = 0.05
[damping]
stiffness_proportional = )" + std::string(damping) +
                              "\n";
    for (const char* method : {"dopri5", "extrapolation8"}) {
      SceneRun run(scene, {std::string("integrator.type=") + method});
      const double sag = run.system().initial_displacement.lpNorm<Eigen::Infinity>(),
                   highest = dynamics::frequency_range(run.system(), dynamics::StopState::open)->highest;
      ASSERT_TRUE(run.run().completed) << method;
      EXPECT_LT(run.simulation().state().v.lpNorm<Eigen::Infinity>(), 1e-12 * highest * sag)
          << method << " " << damping;
    }
  }
}

TEST(AtRest, ALoadThatBeginsLaterIsFollowed) {
  const std::string load = R"([[load]]
node = "m"
type = "ramp"
to = 4.0
start = 0.5
end = 0.52
)";
  const auto motion = [&](const std::string& method) {
    SceneRun run(pressed_mass(kStop, load), {"integrator.type=" + method, "integrator.tolerance=1e-6"});
    Sampler sampler(run.dof("m"), {0.4, 0.51, 0.55, 0.7, 0.9});
    run.simulation().add(sampler);
    EXPECT_TRUE(run.run().completed) << method;
    return sampler.x;
  };
  const auto wanted = motion("exact");
  EXPECT_GT(std::abs(wanted.back() - wanted.front()), 1e-5);
  for (const char* method : {"rodas4", "dopri5", "extrapolation8", "exponential", "bathe_adaptive"})
    EXPECT_LT(relative_rms(motion(method), wanted), 1e-5) << method;
}

/// A beam that lies on stops of gap 0 at all nodes, of which those near the supports may be open or closed to rounding.
TEST(AtRest, ABeamOnItsBed) {
  const std::string scene = R"(
schema = 1
[material.steel]
young_modulus = 2.03e11
density = 7900.0
[section.pipe]
shape = "circle"
radius = 0.05
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "pipe"
length = 10.0
elements = 100
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[[contact]]
type = "stop"
nodes = "b:all"
gap = 0.0
law = "linear"
stiffness = 1e4
[integrator]
type = "auto"
end_time = 0.01
)";
  for (const char* method : {"auto", "exponential", "rodas4"}) expect_rest(scene, method);
}

/// A beam on stops that are much stiffer than it is. The rounding of their forces moves all modes; steps of explicit
/// methods and of exponential are at the limit of stability with closed stops, 20000 rad/s, and not below it.
TEST(AtRest, ABeamOnStiffStops) {
  const std::string scene = R"(
schema = 1
[material.steel]
young_modulus = 2e11
density = 7900.0
[section.rod]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "rod"
length = 4.0
elements = 10
[[support]]
nodes = "b:first"
fix = ["u"]
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[[contact]]
type = "stop"
nodes = "b:all"
sides = "negative"
gap = 0.0
law = "linear"
stiffness = 1e8
[integrator]
type = "auto"
end_time = 1.0
tolerance = )";
  for (const char* tolerance : {"1e-3\n", "1e-6\n"}) {
    for (const char* method : {"auto", "rodas4", "bathe_adaptive", "generalized_alpha_adaptive", "hht_alpha_adaptive"})
      expect_rest(scene + tolerance, method);
    for (const char* method : {"exponential", "central_differences_adaptive", "extrapolation8"})
      expect_rest(scene + tolerance, method, 20000);
    expect_rest(scene + tolerance, "dopri5", 40000);
  }
}

/// Two masses whose static position is where a stop just closes, and loads so near to that of this position that the
/// stop opens and closes by parts of 1e-8 of the displacement. Rounding crosses the border as well, and steps that end
/// at every crossing went on for ever.
TEST(AtRest, TwoMassesWhereAStopJustCloses) {
  const auto scene = [](const std::string& law, const std::string& load) {
    return R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "mass"
name = "q"
mass = 0.3
[[element]]
type = "spring"
node = "m"
stiffness = 1e4
damping = 3.0
[[element]]
type = "spring"
nodes = ["m", "q"]
stiffness = 5e3
[initial]
displacement = [{ nodes = ["m", "q"], value = 1e-3 }]
[integrator]
type = "exponential"
tolerance = 1e-4
end_time = 0.6
[[load]]
node = "m"
type = "constant"
value = )" +
           load + R"(
[[contact]]
type = "stop"
nodes = "q"
gap = 1e-3
sides = "positive"
)" + law;
  };
  for (const char* law : {"law = \"linear\"\nstiffness = 2.4e6\n", "law = \"hertz\"\nstiffness = 1e8\nexponent = 1.5\n",
                          "law = \"arctan\"\nstiffness = 2.4e6\nregularization = 1e5\n",
                          "law = \"smooth\"\nstiffness = 2.4e6\nwidth = 1e-5\n"})
    for (const char* load : {"10.0", "9.9999999", "10.0000001", "9.9999", "10.0001"}) {
      const auto end_of = [&](const std::string& method) {
        SceneRun run(scene(law, load), {"integrator.type=" + method});
        const auto& report = run.run();
        EXPECT_TRUE(report.completed) << method << law << load << report.message;
        // arctan takes most, 11757: its force bends within 10 um of the gap, where the mass swings.
        EXPECT_LT(report.steps + report.rejected, 20000) << method << law << load;
        return Vector(run.simulation().state().x);
      };
      const Vector found = end_of("exponential"), wanted = end_of("rodas4");
      EXPECT_LT((found - wanted).lpNorm<Eigen::Infinity>(), 1e-3 * 1e-3) << law << load;
    }
}

TEST(AtRest, ADisplacementBesideGravityStaticIsSaidToBeAStartOfTheSearch) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\n"
      "stiffness = 100.0\n[gravity]\nacceleration = [0.0, -10.0, 0.0]\nstatic = true\n[initial]\n"
      "displacement = [{ nodes = \"m\", value = 0.5 }]\n[integrator]\nend_time = 1.0\n";
  const scene::Scene read = read_scene(scene);
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_NE(read.warnings.front().find("is only where the search for the static position begins"), std::string::npos)
      << read.warnings.front();
  SceneRun run(scene);
  EXPECT_NEAR(run.system().initial_displacement[run.dof("m")], -0.1, 1e-12);
}

/// A body that sticks rigidly under a growing load: its displacements are rounding of forces in balance until it slips.
TEST(AtRest, ABodyThatSticksUnderAGrowingLoad) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.5\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\n"
      "stiffness = 2.0e4\n[[contact]]\ntype = \"friction\"\nnodes = \"a\"\nnormal_force = 100.0\nfriction = { "
      "coefficient = 0.3, "
      "stick = \"rigid\" }\n[[load]]\ntype = \"ramp\"\nnode = \"a\"\nto = 60.0\nend = 0.1\n[integrator]\ntype = "
      "\"exact\"\n"
      "end_time = 0.8\n";
  SceneRun exact(scene);
  ASSERT_TRUE(exact.run().completed);
  const double x = exact.simulation().state().x[0];
  EXPECT_GT(x, 1e-3);
  for (const std::string method : {"auto", "dopri5", "extrapolation8"}) {
    SceneRun other(scene, {"integrator.type=" + method, "integrator.tolerance=1e-6"});
    const time::RunReport& report = other.run();
    ASSERT_TRUE(report.completed) << method << ": " << report.message;
    EXPECT_NEAR(other.simulation().state().x[0], x, 1e-5 * x) << method;
    EXPECT_LT(report.steps, 3000) << method;
  }
}

/// A static position under gravity beside a load that grows from zero: rounding of the large elastic forces is no
/// motion.
TEST(AtRest, ABeamInItsStaticPositionUnderALoadThatGrows) {
  const std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7850.0\n[section.s]\nshape = \"rectangle\"\nwidth = "
      "0.03\n"
      "height = 0.05\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"s\"\nlength = "
      "1.5\nelements = 10\n"
      "[[support]]\nnodes = [\"b:first\"]\nfix = [\"u\", \"theta\"]\n[[load]]\ntype = \"ramp\"\nnode = \"b:last\"\nto "
      "= 500.0\n"
      "end = 0.2\n[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n[integrator]\nend_time = 2e-3\n";
  SceneRun exponential(scene, {"integrator.type=exponential"});
  ASSERT_TRUE(exponential.run().completed);
  const Index tip = exponential.dof("b:last");
  const double begin = exponential.system().initial_displacement[tip];
  const double moved = exponential.simulation().state().x[tip] - begin;
  ASSERT_GT(moved, 1e-9);
  for (const std::string method : {"bathe_adaptive", "rodas4"}) {
    SceneRun other(scene, {"integrator.type=" + method});
    const time::RunReport& report = other.run();
    ASSERT_TRUE(report.completed) << method << ": " << report.message;
    EXPECT_NEAR(other.simulation().state().x[tip] - begin, moved, 0.01 * moved) << method;
    EXPECT_LT(report.steps, 100000) << method;
  }
}

/// A small late load on a beam with strong stiffness-proportional damping: rounding of the balanced forces falls with h
/// as the error bound nearly does, and accepted steps shrank to 1e-8 s (579 000 steps and more).
TEST(AtRest, ALateLoadOnADampedBeamDoesNotLeadToTinySteps) {
  const std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2.0e11\ndensity = 7800.0\n[section.s]\nshape = \"circle\"\nradius = "
      "0.06\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"s\"\nlength = 6.5\nelements = "
      "30\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n[damping]\nstiffness_proportional = 1e-4\n"
      "[[load]]\ntype = \"table\"\nnode = \"b:middle\"\ntimes = [0.005, 0.006]\nvalues = [0.0, 3.0]\n[gravity]\n"
      "acceleration = [0.0, -9.81, 0.0]\nstatic = true\n[integrator]\nend_time = 0.01\n";
  SceneRun exact(scene, {"integrator.type=exponential", "integrator.tolerance=1e-8"});
  ASSERT_TRUE(exact.run().completed);
  const Index middle = exact.dof("b:middle");
  const double v = exact.simulation().state().v[middle];
  ASSERT_GT(v, 1e-6);
  for (const char* method : {"dopri5", "extrapolation8"})
    for (const char* tolerance : {"1e-4", "1e-6"}) {
      SceneRun run(scene, {std::string("integrator.type=") + method, std::string("integrator.tolerance=") + tolerance});
      const time::RunReport& report = run.run();
      ASSERT_TRUE(report.completed) << method << ": " << report.message;
      EXPECT_NEAR(run.simulation().state().v[middle], v, 10.0 * std::stod(tolerance) * v) << method << " " << tolerance;
      EXPECT_LT(report.steps, 20000) << method << " " << tolerance;
    }
}

/// A shaft in its static position in rings begins to rub: the rounding of the forces in balance is larger than the
/// errors that the still small velocities allow, and neither keeps the steps short nor uses up the error account. 769
/// steps (7019 when it did).
TEST(AtRest, RubbingBeginsFromAStaticPosition) {
  SceneRun run(R"(
schema = 1
[material.s]
young_modulus = 2e11
poisson_ratio = 0.3
density = 7800.0
[section.p]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
motion = "lateral"
theory = "rayleigh"
material = "s"
section = "p"
length = 4.0
elements = 60
[[support]]
nodes = ["b:first", "b:last"]
fix = ["uy", "uz"]
[rotation]
speed = { type = "ramp", from = 20.0, to = 80.0, end = 0.15 }
[damping]
mass_proportional = 1.0
rotating_stiffness_proportional = 2e-5
[gravity]
acceleration = [0, -9.81, 0]
static = true
[[load]]
type = "unbalance"
node = "b:20"
moment = 0.05
[[contact]]
type = "ring"
nodes = "b:all"
gap = 9e-3
stiffness = 2e5
damping = { type = "hunt_crossley", factor = 0.3 }
friction = { coefficient = 0.2, slip_speed = 0.02 }
radius = 0.02
[integrator]
type = "rodas4"
tolerance = 1e-5
end_time = 0.02
)");
  const auto& report = run.run();
  EXPECT_TRUE(report.completed) << report.message;
  EXPECT_LT(report.steps, 1500);
}

/// A body that only a stop or a plane below it holds: it rests at gap + m g/k. What nothing holds is refused.
TEST(AtRest, ABodyThatOnlyAContactHolds) {
  const auto scene = [](const std::string& contact) {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[gravity]\nacceleration = [0.0, -9.81, "
           "0.0]\n"
           "static = true\n" +
           contact + "[integrator]\ntype = \"rodas4\"\nend_time = 0.1\n";
  };
  const std::string stop = "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1e-3\nstiffness = 1e5\n";
  const std::string damped = "damping = { type = \"kelvin_voigt\", coefficient = 10.0 }\n";
  for (const std::string& contact : {stop, stop + damped, stop + "sides = \"negative\"\n"}) {
    SceneRun run(scene(contact));
    EXPECT_NEAR(run.system().initial_displacement[0], -1e-3 - 2.0 * 9.81 / 1e5, 1e-12) << contact;
    ASSERT_TRUE(run.run().completed);
    EXPECT_NEAR(run.simulation().state().x[0], -1e-3 - 2.0 * 9.81 / 1e5, 1e-9) << contact;
  }
  for (const std::string& contact : {std::string(), stop + "sides = \"positive\"\n"}) try {
      SceneRun run(scene(contact));
      FAIL() << "was taken: " << contact;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("nothing holds u of m"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace butee::test::at_rest_test

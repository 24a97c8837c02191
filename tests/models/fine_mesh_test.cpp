// Beams of many short elements: element forces are far larger than their sums, so that rounding of the residual exceeds
// Newton's tolerances.
#include <cmath>
#include <cstdio>
#include <iterator>
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

/// A mass of 1000 kg beside one of 1 g on a spring of 1e12 N/m: the square of its frequency is 1e-15 of the other one.
TEST(SlowModes, OscillateBesideFarFasterOnes) {
  for (const std::string mass : {"0.1", "0.001", "1e-5"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1000.0\n[[element]]\ntype = "
        "\"spring\"\nnode = \"a\"\nstiffness = 1e3\n[[element]]\ntype = \"mass\"\nname = \"p\"\nmass = " +
        mass +
        "\n[[element]]\ntype = \"spring\"\nnode = \"p\"\nstiffness = 1e12\n[[element]]\ntype = "
        "\"spring\"\nnodes = [\"a\", \"p\"]\nstiffness = 10.0\n[initial]\ndisplacement = [{ nodes = \"a\", "
        "value = 0.01 }]\n[integrator]\ntype = \"exponential\"\nend_time = 10.0\n");
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(run.simulation().state().x[run.dof("a")], 0.01 * std::cos(std::sqrt(1.01) * 10.0), 1e-9) << mass;
  }
}

/// A pinned rod of 4 m, one of whose elements is 0.5 mm long. Its lowest frequency is pi^2 sqrt(EI/(rho A))/L^2; with
/// modal damping a free vibration in its mode decays as e^(-zeta omega t).
TEST(SlowModes, OfABeamWithAShortElement) {
  const double radius = 0.02, length = 4.0,
               omega = 9.8696044010893586 * std::sqrt(2.1e11 * radius * radius / 4.0 / 7850.0) / (length * length);
  const std::string scene = R"(
schema = 1
[material.s]
young_modulus = 2.1e11
density = 7850.0
[section.c]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "c"
coordinates = [0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2.0, 2.0005, 2.25, 2.5, 2.75, 3, 3.25, 3.5, 3.75, 4]
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[integrator]
type = "exponential"
end_time = 1.0
[damping]
modal = 0.05
[initial]
)";
  std::string start = "displacement = [";
  const double places[] = {0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2.0, 2.0005, 2.25, 2.5, 2.75, 3, 3.25, 3.5, 3.75};
  for (std::size_t i = 0; i < std::size(places); ++i) {
    const double turn = 3.141592653589793 * places[i] / length;
    const std::string node = "{ nodes = \"b:" + std::to_string(i + 1) + "\", ";
    start += node + "value = " + std::to_string(0.01 * std::sin(turn)) + " }, " + node +
             "dof = \"theta\", value = " + std::to_string(0.01 * 3.141592653589793 / length * std::cos(turn)) + " }, ";
  }
  SceneRun run(scene + start.substr(0, start.size() - 2) + "]\n");
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double damped = omega * std::sqrt(1.0 - 0.05 * 0.05), decay = std::exp(-0.05 * omega),
               expected = 0.01 * decay * (std::cos(damped) + 0.05 * omega / damped * std::sin(damped));
  // The rotations of the ends, which start at 0, set higher modes in motion.
  EXPECT_NEAR(run.simulation().state().x[run.dof("b:8")], expected, 0.03 * 0.01 * decay);
}

/// A straight pinned rod of 100 elements at 0.9999 of its critical load under its weight: the closed series of its odd
/// modes, omega_k^2 = (k pi/L)^2 ((k pi/L)^2 EI - P)/(rho A).
TEST(SlowModes, OfANearlyBuckledRod) {
  const double pi = 3.141592653589793, radius = 0.02, length = 4.0, ei = 2.1e11 * pi * std::pow(radius, 4) / 4.0,
               per_length = 7850.0 * pi * radius * radius, critical = pi * pi * ei / (length * length),
               load = 0.9999 * critical, end = 5.0;
  char scene[1200];
  std::snprintf(scene, sizeof scene, R"(
schema = 1
[material.s]
young_modulus = 2.1e11
density = 7850.0
[section.c]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "c"
length = 4.0
elements = 100
preload = %.17g
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[gravity]
acceleration = [0.0, -9.81, 0.0]
[integrator]
type = "exponential"
end_time = 5.0
)",
                -load);
  SceneRun run(scene);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  double expected = 0.0;
  for (int k = 1; k < 60; k += 2) {
    const double wave = k * pi / length, square = wave * wave * (wave * wave * ei - load) / per_length,
                 amplitude = -4.0 * 9.81 / (k * pi) / square * (k % 4 == 1 ? 1.0 : -1.0);
    expected += amplitude * (1.0 - std::cos(std::sqrt(square) * end));
  }
  EXPECT_NEAR(run.simulation().state().x[run.dof("b:50")], expected, 1e-4 * std::abs(expected));
}

}  // namespace
}  // namespace butee::test::fine_mesh_test

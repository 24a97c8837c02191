#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "butee/dynamics/frequencies.hpp"
#include "support/scene_run.hpp"
#include "verification/methods.hpp"

namespace butee::test::rigid_motion_test {
namespace {

/// Momentum is a linear invariant and grows linearly under a constant force; every method here reproduces
/// this up to rounding (and Newton's tolerance) over some thousand steps.
constexpr double kMomentum = 1e-8;
/// Newton's stopping criterion and rounding, relative to the motion.
constexpr double kRigid = 1e-8;

constexpr double kLength = 2.0, kMass = 8000.0 * 2e-3 * kLength, kInertia = kMass * kLength * kLength / 12;
constexpr double kEnd = 0.02;

/// A free beam. Source: Newton and Euler: the centre of mass accelerates with F/m, and the angular momentum
/// grows with the moment of the force. A uniform force does not bend the beam.
std::string free_beam(const std::string& load) {
  return R"(
schema = 1

[material.steel]
young_modulus = 2.0e11
density       = 8000.0

[section.bar]
shape         = "general"
area          = 2.0e-3
second_moment = 1.0e-8

[[element]]
type        = "beam"
name        = "rod"
material    = "steel"
section     = "bar"
coordinates = [0.0, 0.3, 0.8, 1.2, 1.5, 2.0]

[integrator]
end_time = 0.02

[[load]]
)" + load;
}

/// Translation of all nodes, and rotation of all nodes about the middle.
struct RigidModes {
  explicit RigidModes(const SceneRun& scene) : shift(Vector::Zero(scene.system().size())), turn(shift) {
    const double x[] = {0.0, 0.3, 0.8, 1.2, 1.5, 2.0};
    for (int i = 0; i < 6; ++i) {
      const std::string node = "rod:" + std::to_string(i);
      shift[scene.dof(node)] = 1.0;
      turn[scene.dof(node)] = x[i] - 0.5 * kLength;
      turn[scene.dof(node, DofKind::theta)] = 1.0;
    }
  }
  Vector shift, turn;
};

class RigidMotion : public testing::TestWithParam<Method> {
 protected:
  /// The beam's fastest mode requires smaller steps of the explicit method than the oscillator.
  static std::vector<std::string> overrides() {
    auto all = GetParam().overrides();
    if (GetParam().name == "rk4") all.emplace_back("integrator.time_step=2e-5");
    return all;
  }
};

TEST_P(RigidMotion, AUniformForceMovesTheBeamWithoutBendingIt) {
  constexpr double kLoad = 500.0;
  SceneRun scene(free_beam("type = \"distributed\"\nbeam = \"rod\"\nvalue = 500.0\n"), overrides());
  const RigidModes modes(scene);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;
  const double acceleration = kLoad * kLength / kMass, speed = acceleration * kEnd, way = 0.5 * speed * kEnd;
  const time::State& state = scene.simulation().state();
  EXPECT_LE((state.x - way * modes.shift).lpNorm<Eigen::Infinity>(), kRigid * way);
  EXPECT_LE((state.v - speed * modes.shift).lpNorm<Eigen::Infinity>(), kRigid * speed);
}

TEST_P(RigidMotion, AForceAtTheEndMovesTheCentreOfMassAndTurnsTheBeam) {
  constexpr double kForce = 300.0;
  SceneRun scene(free_beam("type = \"constant\"\nnode = \"rod:last\"\nvalue = 300.0\n"), overrides());
  const RigidModes modes(scene);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;
  const time::State& state = scene.simulation().state();
  const Vector momenta = scene.system().mass * state.v, places = scene.system().mass * state.x;
  const double momentum = kForce * kEnd, spin = kForce * 0.5 * kLength * kEnd;
  EXPECT_NEAR(modes.shift.dot(momenta), momentum, kMomentum * momentum);
  EXPECT_NEAR(modes.turn.dot(momenta), spin, kMomentum * spin);
  const double way = 0.5 * kForce / kMass * kEnd * kEnd, angle = 0.5 * kForce * 0.5 * kLength / kInertia * kEnd * kEnd;
  EXPECT_NEAR(modes.shift.dot(places) / kMass, way, kMomentum * way);
  EXPECT_NEAR(modes.turn.dot(places) / kInertia, angle, kMomentum * angle);
}

/// A free beam of 2 m whose nodes have these coordinates, on springs at its ends (N/m) unless they are 0.
std::string beam_on_springs(const std::vector<double>& coordinates, double stiffness) {
  std::string beam = free_beam("type = \"distributed\"\nbeam = \"rod\"\nvalue = 500.0\n"), list;
  for (const double x : coordinates) list += (list.empty() ? "" : ", ") + to_text(x);
  const std::string given = "0.0, 0.3, 0.8, 1.2, 1.5, 2.0";
  beam.replace(beam.find(given), given.size(), list);
  for (const std::size_t node : {std::size_t{0}, coordinates.size() - 1})
    if (stiffness != 0.0)
      beam += "\n[[element]]\ntype = \"spring\"\nnode = \"rod:" + std::to_string(node) +
              "\"\nstiffness = " + to_text(stiffness) + "\n";
  return beam;
}

TEST(RigidMotion, OfUnevenMeshesIsFound) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, kLength);
  for (const int elements : {20, 50, 100, 200}) {
    std::vector<double> coordinates = {0.0, kLength};
    for (int i = 1; i < elements; ++i) coordinates.push_back(place(random));
    std::ranges::sort(coordinates);
    SceneRun scene(beam_on_springs(coordinates, 0.0));
    const auto modes = dynamics::lowest_modes(scene.system(), scene.system().size());
    ASSERT_TRUE(modes);
    EXPECT_EQ(modes->frequencies[0], 0.0) << elements;
    EXPECT_EQ(modes->frequencies[1], 0.0) << elements;
    EXPECT_GT(modes->frequencies[2], 1.0) << elements;
  }
}

/// The stiffness of the springs is 1e-13 of that of the elements. On them the rigid beam has omega^2 = 2k/m, and
/// (k L^2/2)/(m L^2/12) = 6k/m as it turns.
TEST(RigidMotion, OnSoftSpringsIsNoRigidMotion) {
  constexpr double kSpring = 0.01;
  // With uneven elements K has rounding where their stiffnesses are added.
  for (const double longer : {1.0, 1.5}) {
    std::vector<double> coordinates = {0.0};
    for (int i = 0; i < 100; ++i) {
      coordinates.push_back(0.02 * i + 0.02 / (1.0 + longer));
      coordinates.push_back(0.02 * (i + 1));
    }
    SceneRun scene(beam_on_springs(coordinates, kSpring));
    const auto modes = dynamics::lowest_modes(scene.system(), scene.system().size());
    ASSERT_TRUE(modes);
    EXPECT_NEAR(modes->frequencies[0], std::sqrt(2.0 * kSpring / kMass), 1e-5 * modes->frequencies[0]) << longer;
    EXPECT_NEAR(modes->frequencies[1], std::sqrt(6.0 * kSpring / kMass), 1e-5 * modes->frequencies[1]) << longer;
  }
}

/// Two masses joined by a spring and a dashpot, driven, whose stop is out of reach: steps are not far shorter without a
/// spring to ground, or with a soft one, than with a stiff one.
TEST(RigidMotion, UnderLoadsTakesLongSteps) {
  const auto steps_of = [](const std::string& more) {
    SceneRun run(R"(schema = 1
[[element]]
type = "mass"
name = "a"
mass = 0.8
[[element]]
type = "mass"
name = "b"
mass = 0.9
[[element]]
type = "spring"
nodes = ["a", "b"]
stiffness = 787.0
damping = 0.9
[[contact]]
type = "stop"
nodes = "a"
gap = 1000.0
stiffness = 1e4
damping = { type = "kelvin_voigt", coefficient = 1.0 }
[[load]]
type = "harmonic"
node = "a"
amplitude = 0.12
angular_frequency = 20.0
[initial]
displacement = [{ nodes = "b", value = 1e-3 }]
[integrator]
type = "exponential"
tolerance = 1e-6
end_time = 2.0
)" + more);
    EXPECT_TRUE(run.run().completed);
    return run.simulation().report().steps;
  };
  const auto grounded = steps_of("[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 100.0\n"),
             soft = steps_of("[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 1e-6\n"), free = steps_of("");
  // It took 40 times as many.
  EXPECT_LT(free, 8 * grounded);
  EXPECT_LT(soft, 2 * grounded);
}

/// A free beam in any direction starts in rigid rotation about an axis along z and does not strain.
TEST(RigidMotion, ByAnInitialRotationOfABeamInSpace) {
  for (const char* points : {"[[0, 0, 0], [1, 1, 0]]", "[[2, 0, 0], [0, 0, 0]]", "[[0, 0, 0], [-1, 2, 0]]"}) {
    SceneRun run(std::string(R"(schema = 1
[material.m]
young_modulus = 2.1e11
density = 7800.0
poisson_ratio = 0.3
[section.s]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "m"
section = "s"
motion = "spatial"
elements = 4
[initial]
velocity = [{ nodes = "b:all", rotation = 1.5, about = 0.7 }]
[integrator]
end_time = 1e-3
)"),
                 {std::string("element[0].points=") + points});
    const auto& v = run.system().initial_velocity;
    const double kinetic = 0.5 * v.dot(run.system().mass * v);
    EXPECT_GT(kinetic, 1.0) << points;
    ASSERT_TRUE(run.run().completed);
    const auto& x = run.simulation().state().x;
    // x = v t, which strains nothing.
    EXPECT_LT(0.5 * x.dot(run.system().stiffness * x), 1e-9 * kinetic) << points;
  }
}

INSTANTIATE_TEST_SUITE_P(methods, RigidMotion, testing::ValuesIn(all_methods()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace butee::test::rigid_motion_test

#include <cmath>

#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::loads_test {
namespace {

/// Rounding of a few operations on numbers of similar size.
constexpr double kRounding = 1e-14;

std::string load(const std::string& keys) {
  return "\n[[load]]\n" + keys + "\n";
}

/// F(t) on a lone mass for the given loads.
class LoadedMass {
 public:
  explicit LoadedMass(const std::string& loads) : scene_(kHeader + mass("ball", "2.0") + loads) {}

  double at(double t) {
    Vector force(1);
    scene_.dynamics().external_force(t, force);
    return force[0];
  }
  const model::System& system() const { return scene_.system(); }

 private:
  SceneRun scene_;
};

TEST(Load, HarmonicIsACosineWithAPhase) {
  LoadedMass ball(load("type = \"harmonic\"\nnode = \"ball\"\namplitude = 30.0\nangular_frequency = 7.0\nphase = 0.4"));
  for (const double t : {0.0, 0.1, 3.7}) EXPECT_NEAR(ball.at(t), 30.0 * std::cos(7.0 * t + 0.4), 30.0 * kRounding);
}

TEST(Load, UnbalanceGrowsWithTheSquareOfTheSpeed) {
  LoadedMass ball(load("type = \"unbalance\"\nnode = \"ball\"\nmoment = 0.02\nspeed = 50\nphase = -1.0"));
  for (const double t : {0.0, 0.1, 3.7}) EXPECT_NEAR(ball.at(t), 50.0 * std::cos(50.0 * t - 1.0), 50.0 * kRounding);
}

TEST(Load, ConstantStays) {
  LoadedMass ball(load("type = \"constant\"\nnode = \"ball\"\nvalue = -12.5"));
  for (const double t : {0.0, 0.1, 1e6}) EXPECT_EQ(ball.at(t), -12.5);
}

TEST(Load, RampIsLinearBetweenTwoPlateaus) {
  LoadedMass ball(load("type = \"ramp\"\nnode = \"ball\"\nfrom = 2.0\nto = 10.0\nstart = 1.0\nend = 3.0"));
  EXPECT_EQ(ball.at(0.0), 2.0);
  EXPECT_EQ(ball.at(1.0), 2.0);
  EXPECT_DOUBLE_EQ(ball.at(1.5), 4.0);
  EXPECT_DOUBLE_EQ(ball.at(2.75), 9.0);
  EXPECT_EQ(ball.at(3.0), 10.0);
  EXPECT_EQ(ball.at(1e3), 10.0);
  EXPECT_EQ(ball.system().loads.front().in_time->discontinuities(), (std::vector<double>{1.0, 3.0}));
}

TEST(Load, TableIsPiecewiseLinearAndConstantOutside) {
  LoadedMass ball(load("type = \"table\"\nnode = \"ball\"\ntimes = [1, 2, 4]\nvalues = [5, -5, 0]"));
  EXPECT_EQ(ball.at(0.0), 5.0);
  EXPECT_DOUBLE_EQ(ball.at(1.25), 2.5);
  EXPECT_EQ(ball.at(2.0), -5.0);
  EXPECT_DOUBLE_EQ(ball.at(3.0), -2.5);
  EXPECT_EQ(ball.at(9.0), 0.0);
}

/// The last corner of a steep pulse: over the rounding of t the load changes by all of its value, but does not jump.
TEST(Load, CornersAreNoJumps) {
  SceneRun scene(kHeader + mass("ball", "2.0") +
                 load("type = \"table\"\nnode = \"ball\"\ntimes = [0.04, 0.0400000011, 0.0400000022]\nvalues = [0.0, "
                      "1e9, 0.0]"));
  for (const double corner : {0.04, 0.0400000011, 0.0400000022})
    EXPECT_FALSE(scene.dynamics().loads_jump(corner)) << corner;
}

TEST(Load, TwoOnOneNodeAdd) {
  LoadedMass ball(load("type = \"constant\"\nnode = \"ball\"\nvalue = 3.0") +
                  load("type = \"ramp\"\nnode = \"ball\"\nto = 8.0\nend = 2.0"));
  EXPECT_EQ(ball.at(0.0), 3.0);
  EXPECT_DOUBLE_EQ(ball.at(1.0), 7.0);
  EXPECT_EQ(ball.system().loads.size(), 2U);
}

TEST(Load, ZeroOnesVanish) {
  LoadedMass ball(load("type = \"harmonic\"\nnode = \"ball\"\namplitude = 0.0\nangular_frequency = 7.0") +
                  load("type = \"table\"\nnode = \"ball\"\ntimes = [0, 1]\nvalues = [0, 0]") +
                  load("type = \"unbalance\"\nnode = \"ball\"\nmoment = 1.0\nspeed = 0") +
                  load("type = \"constant\"\nnode = \"ball\"\nvalue = 1.0"));
  EXPECT_EQ(ball.system().skipped_loads, 3);
  EXPECT_EQ(ball.system().loads.size(), 1U);
  EXPECT_EQ(ball.at(0.5), 1.0);
}

TEST(Load, OnThetaIsAMoment) {
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 1.0\nelements = 2") +
                 load("type = \"constant\"\nnode = \"arm:1\"\ndof = \"theta\"\nvalue = 40.0"));
  Vector force(scene.system().size());
  scene.dynamics().external_force(0.0, force);
  EXPECT_EQ(force[scene.dof("arm:1", DofKind::theta)], 40.0);
  EXPECT_EQ(force.lpNorm<1>(), 40.0);
}

/// q l/2 and q l^2/12 at the ends of every element, times the time function. They do the same work as the
/// load on the Hermite cubics.
TEST(Load, DistributedHasConsistentNodalLoadsInTime) {
  constexpr double kLoad = -600.0;
  SceneRun scene(kHeader + kSteelBar + beam("arm", "coordinates = [0.0, 0.5, 2.0]") +
                 load("type = \"distributed\"\nbeam = \"arm\"\nvalue = -600.0\nin_time = {type = \"ramp\", from = 1.0, "
                      "to = 3.0, end = 1.0}"));
  const double l1 = 0.5, l2 = 1.5;
  Vector expected(scene.system().size()), force(expected.size());
  expected[scene.dof("arm:0")] = kLoad * l1 / 2;
  expected[scene.dof("arm:1")] = kLoad * (l1 + l2) / 2;
  expected[scene.dof("arm:2")] = kLoad * l2 / 2;
  expected[scene.dof("arm:0", DofKind::theta)] = kLoad * l1 * l1 / 12;
  expected[scene.dof("arm:1", DofKind::theta)] = kLoad * (l2 * l2 - l1 * l1) / 12;
  expected[scene.dof("arm:2", DofKind::theta)] = -kLoad * l2 * l2 / 12;
  for (const auto& [t, factor] : {std::pair(0.0, 1.0), std::pair(0.5, 2.0), std::pair(7.0, 3.0)}) {
    scene.dynamics().external_force(t, force);
    EXPECT_LE((force - factor * expected).norm(), kRounding * expected.norm() * factor) << t;
  }
}

TEST(Load, DistributedWithoutACourseIsConstantAndZeroVanishes) {
  const std::string on_arm = "type = \"distributed\"\nbeam = \"arm\"\nvalue = ";
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 3.0\nelements = 3") + load(on_arm + "10.0") +
                 load(on_arm + "0.0"));
  EXPECT_EQ(scene.system().skipped_loads, 1);
  Vector force(scene.system().size());
  scene.dynamics().external_force(99.0, force);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += force[scene.dof("arm:" + std::to_string(i))];
  EXPECT_DOUBLE_EQ(sum, 30.0);
}

TEST(Load, MistakesAreNamed) {
  const std::string beginning = kHeader + mass("ball", "2.0");
  const auto expect = [&](const std::string& keys, const std::string& part) {
    const std::string message = refusal(beginning + load(keys));
    EXPECT_TRUE(holds(message, part)) << "wanted \"" << part << "\" in \"" << message << "\"";
  };
  expect("type = \"ramp\"\nnode = \"ball\"\nto = 1.0\nstart = 2.0\nend = 2.0", "load[0].end = 2.0: must be later");
  expect("type = \"table\"\nnode = \"ball\"\ntimes = [0, 1]\nvalues = [1]", "load[0].values");
  expect("type = \"table\"\nnode = \"ball\"\ntimes = [0, 0]\nvalues = [1, 2]", "load[0].times");
  expect("type = \"table\"\nnode = \"ball\"\ntimes = []\nvalues = []", "load[0].times");
  expect("type = \"harmonc\"\nnode = \"ball\"", "did you mean \"harmonic\"?");
  expect("type = \"constant\"\nnode = \"ball\"\ndof = \"theta\"\nvalue = 1.0", "theta of ball does not exist");
  expect("type = \"constant\"\nnode = \"bell\"\nvalue = 1.0", "did you mean \"ball\"?");
  expect("type = \"distributed\"\nbeam = \"ball\"\nvalue = 1.0", "is not a beam");
}

}  // namespace
}  // namespace butee::test::loads_test

// Errors of the method exponential that have one sign in every step or impact, and would add up over a long run,
// against closed forms.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::exponential_long_runs_test {
namespace {

/// A mass on a spring that flies to and fro between hard stops, beside another one or alone. Each impact takes or
/// gives a little energy; after all of them it is that of the start.
TEST(Exponential, KeepsTheEnergyThroughHundredsOfImpacts) {
  constexpr double kSpeed = 1.9, kStiffness = 420.0, kGap = 0.02;
  const std::string mass = "[[element]]\ntype = \"mass\"\nmass = 1.0\nname = ";
  const std::string flight =
      "schema = 1\n" + mass +
      "\"m\"\n[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 420.0\n[[contact]]\ntype = "
      "\"stop\"\nnodes = \"m\"\ngap = 0.02\nlaw = \"linear\"\nstiffness = 1.6e9\n[initial]\nvelocity "
      "= [{ nodes = \"m\", value = 1.9 }]\n[integrator]\ntype = \"exponential\"\nend_time = 3.0\n";
  for (const std::string& other : {std::string(), mass + "\"other\"\n"})
    for (const char* tolerance : {"1e-3", "1e-4", "1e-5", "1e-6", "1e-7"}) {
      SceneRun run(flight + other, {std::string("integrator.tolerance=") + tolerance});
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const Index m = run.dof("m");
      const double x = run.simulation().state().x[m], v = run.simulation().state().v[m];
      ASSERT_LT(std::abs(x), kGap);
      // The account of the stop allows 4.4 tolerances of the speed.
      EXPECT_NEAR((v * v + kStiffness * x * x) / (kSpeed * kSpeed), 1.0, 2.0 * 4.4 * std::stod(tolerance))
          << tolerance << other;
    }
}

/// A mass pressed on a stop oscillates there for 950 periods: x = 1.5 mm at the start, about 1 mm + F/k = 2 mm.
TEST(Exponential, KeepsThePhaseOfAMassThatStaysOnItsStop) {
  constexpr double kStiffness = 1e8, kMiddle = 2e-3, kAmplitude = -0.5e-3;
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
      "\"m\"\ngap = "
      "0.001\nsides = \"positive\"\nlaw = \"linear\"\nstiffness = 1e8\n[[load]]\nnode = \"m\"\ntype = "
      "\"constant\"\nvalue = "
      "1e5\n[initial]\ndisplacement = [{ nodes = \"m\", value = 0.0015 }]\n[integrator]\ntype = "
      "\"exponential\"\nend_time = 0.6\n";
  const double omega = std::sqrt(kStiffness);
  std::vector<double> times;
  for (int i = 0; i <= 200; ++i) times.push_back(3e-3 * i);
  for (const std::string& other :
       {std::string(), std::string("[[element]]\ntype = \"mass\"\nname = \"o\"\nmass = 1.0\n")})
    for (const char* tolerance : {"1e-3", "1e-4", "1e-6", "1e-8"}) {
      SceneRun run(scene + other, {std::string("integrator.tolerance=") + tolerance});
      Sampler sampler(run.dof("m"), times);
      run.simulation().add(sampler);
      ASSERT_TRUE(run.run().completed);
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double allowed = 10.0 * std::stod(tolerance);
        EXPECT_NEAR(sampler.x[i], kMiddle + kAmplitude * std::cos(omega * times[i]), allowed * 2.5e-3) << tolerance;
        EXPECT_NEAR(sampler.v[i], -kAmplitude * omega * std::sin(omega * times[i]), allowed * 5.0) << tolerance;
      }
    }
}

/// A stiff rotation spring at the end of a beam vibrates hundreds of times faster than the beam, and a stop without a
/// gap raises its frequency a little in all of the run. Without the stop's part in each step the phase is wrong in the
/// end.
TEST(Exponential, KeepsThePhaseOfFastModesOnAClosedStop) {
  const std::string scene = R"(schema = 1
[material.m]
young_modulus = 2.1e11
density = 7800.0
[section.s]
shape = "circle"
radius = 0.01
[[element]]
type = "beam"
name = "b"
material = "m"
section = "s"
length = 1.0
elements = 2
[[support]]
nodes = ["b:0"]
fix = ["u", "theta"]
[[element]]
type = "spring"
node = "b:last"
dof = "theta"
stiffness = 3e6
[[contact]]
type = "stop"
nodes = "b:last"
gap = 0.0
stiffness = 2e6
sides = "both"
law = "linear"
[initial]
velocity = [{ nodes = "b:last", dof = "theta", value = 1.0 }]
[integrator]
type = "exponential"
end_time = 0.5
)";
  // The closed form: the same scene with a spring in place of the stop has no contact.
  std::string with_spring = scene;
  const auto begin = with_spring.find("[[contact]]"), end = with_spring.find("[initial]");
  with_spring.replace(begin, end - begin,
                      "[[element]]\ntype = \"spring\"\nnode = \"b:last\"\ndof = \"u\"\nstiffness = 2e6\n");
  std::vector<double> times;
  for (int i = 0; i <= 200; ++i) times.push_back(2.5e-3 * i);
  const auto run_of = [&](const std::string& text, const char* tolerance) {
    SceneRun run(text, {std::string("integrator.tolerance=") + tolerance});
    Sampler sampler(run.dof("b:last", DofKind::theta), times);
    run.simulation().add(sampler);
    EXPECT_TRUE(run.run().completed);
    return sampler.v;
  };
  const std::vector<double> exact = run_of(with_spring, "1e-4");
  for (const char* tolerance : {"1e-2", "1e-3", "1e-4", "1e-6"}) {
    const std::vector<double> v = run_of(scene, tolerance);
    ASSERT_EQ(v.size(), exact.size());
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      worst = std::max(worst, std::abs(v[i] - exact[i]));
      largest = std::max(largest, std::abs(exact[i]));
    }
    // The account allows 4.4 tolerances.
    EXPECT_LT(worst / largest, 6.0 * std::stod(tolerance)) << tolerance;
  }
}

/// A beam at rest on a stop under its weight. Neither the force of a law that is not linear nor speeds of rounding may
/// be taken for vibrations of its modes, which would need 5457 steps.
TEST(Exponential, TakesFewStepsAtRestOnAClosedStop) {
  const std::string scene = R"(schema = 1
[material.m]
young_modulus = 2.1e11
density = 7850.0
[section.s]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "m"
section = "s"
length = 4.0
elements = 20
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = ["b:middle"]
gap = 1e-3
law = "hertz"
stiffness = 1e9
[integrator]
type = "exponential"
end_time = 0.02
)";
  SceneRun run(scene);
  const Index middle = run.dof("b:middle");
  const double u = run.simulation().state().x[middle];
  ASSERT_LT(u, -1e-3);
  ASSERT_TRUE(run.run().completed);
  EXPECT_NEAR(run.simulation().state().x[middle], u, 1e-12);
  EXPECT_LT(run.simulation().report().steps, 500);
}

}  // namespace
}  // namespace butee::test::exponential_long_runs_test

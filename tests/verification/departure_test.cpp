// Starts in the middle of a stop with two sides whose law has a residual force there (leave_middle()).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::departure_test {
namespace {

constexpr double kStiffness = 100.0, kLoad = 2.0, kResidual = 1.0, kEnd = 0.5;

/// Two masses of 1 kg that a spring joins; a constant force pulls at the second one. The law of the stop pulls its node
/// towards the nearer side with the residual force, which varies by 1e-7 of it up to 0.3 m.
std::string scene(double load, const std::string& stop = "nodes = \"a\"") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n"
         "[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = 1.0\n"
         "[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = " +
         to_text(kStiffness) +
         "\n[[contact]]\ntype = \"stop\"\ngap = 1.0\nlaw = \"arctan\"\nregularization = 1e3\nstiffness = " +
         to_text(kResidual * std::numbers::pi * std::numbers::pi * 1e3) + "\n" + stop +
         "\n[[load]]\ntype = \"constant\"\nnode = \"b\"\nvalue = " + to_text(load) +
         "\n[integrator]\nend_time = " + to_text(kEnd) + "\n";
}

/// The displacement of the first mass if the residual force acts in the direction of the load from the start.
double expected(double t, double load) {
  const double omega = std::sqrt(2.0 * kStiffness), force = std::abs(load);
  const double apart = (force - kResidual) / (2.0 * kStiffness) * (1.0 - std::cos(omega * t));
  return std::copysign(0.25 * (force + kResidual) * t * t - 0.5 * apart, load);
}

/// The largest difference to that displacement over its final value; the load begins at `start`.
double error_of(const std::string& method, const std::string& step, double load, double start = 0.0) {
  std::vector<double> times;
  for (int i = 1; i <= 50; ++i) times.push_back(start + kEnd * i / 50.0);
  std::vector<std::string> changes = {"integrator.type=" + method, step};
  if (start > 0.0)
    changes.insert(changes.end(), {"load[0].type=\"ramp\"", "load[0].value=", "load[0].to=" + to_text(load),
                                   "load[0].start=" + to_text(start), "load[0].end=" + to_text(start + 1e-10),
                                   "integrator.end_time=" + to_text(start + kEnd)});
  SceneRun run(scene(load), changes);
  Sampler sampler(run.dof("a"), times);
  run.simulation().add(sampler);
  EXPECT_TRUE(run.run().completed) << method;
  EXPECT_EQ(sampler.x.size(), times.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < sampler.x.size(); ++i)
    largest = std::max(largest, std::abs(sampler.x[i] - expected(times[i] - start, load)));
  return largest / std::abs(expected(kEnd, load));
}

class Departure : public testing::TestWithParam<const char*> {};

/// At tolerances where `rodas4` left to the other side.
TEST_P(Departure, LeavesWithTheLoadAndTheResidualForce) {
  constexpr double kTolerance = 1e-5;
  for (const double load : {kLoad, -kLoad})
    for (const double start : {0.0, 0.2}) {
      EXPECT_LT(error_of(GetParam(), "integrator.tolerance=" + to_text(kTolerance), load, start), 10.0 * kTolerance)
          << load << " from " << start;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Departure,
                         testing::Values("auto", "exponential", "rodas4", "dopri5", "extrapolation8", "bathe_adaptive",
                                         "generalized_alpha_adaptive", "hht_alpha_adaptive",
                                         "discrete_gradient_adaptive", "central_differences_adaptive"),
                         [](const auto& one) { return std::string(one.param); });

/// Stops at all nodes of a beam at rest: the force of each acts from the start on the side to which the load drives it,
/// while the motion without these forces alternates from node to node.
TEST(Departure, OfManyStopsIsToTheSideOfTheFirstMotion) {
  const std::string beam =
      "schema = 1\n[material.steel]\nyoung_modulus = 2.1e11\ndensity = 7850.0\npoisson_ratio = 0.3\n[section.pipe]\n"
      "shape = \"tube\"\nouter_radius = 0.02\ninner_radius = 0.015\n[[element]]\ntype = \"beam\"\nname = \"b\"\n"
      "material = \"steel\"\nsection = \"pipe\"\nlength = 2.0\nelements = 20\n[[support]]\nnodes = [\"b:first\", "
      "\"b:last\"]\nfix = [\"u\"]\n[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 0.003\nlaw = \"arctan\"\n"
      "stiffness = 1e5\nregularization = 1e3\n[[load]]\ntype = \"harmonic\"\nnode = \"b:10\"\namplitude = 100.0\n"
      "angular_frequency = 30.0\n[integrator]\nend_time = 1e-3\n";
  SceneRun exact(beam, {"integrator.type=exact"}),
      exponential(beam, {"integrator.type=exponential", "integrator.tolerance=1e-6"});
  ASSERT_TRUE(exact.run().completed);
  ASSERT_TRUE(exponential.run().completed);
  const Vector &wanted = exact.simulation().state().x, &got = exponential.simulation().state().x;
  EXPECT_LT((got - wanted).norm(), 1e-5 * wanted.norm());
}

class FixedSteps : public testing::TestWithParam<const char*> {};

TEST_P(FixedSteps, LeaveWithTheLoadAndTheResidualForce) {
  for (const double load : {kLoad, -kLoad}) {
    EXPECT_LT(error_of(GetParam(), "integrator.time_step=1e-3", load), 1e-5) << load;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, FixedSteps,
                         testing::Values("exact", "central_differences", "bathe", "generalized_alpha", "hht_alpha",
                                         "discrete_gradient"),
                         [](const auto& one) { return std::string(one.param); });

/// The state after start().
time::State started(SceneRun& run, const Vector& x, const Vector& v) {
  time::State state;
  state.x = x;
  state.v = v;
  run.integrator().start(state);
  return state;
}

TEST(LeaveMiddle, FollowsTheSpeedBeforeTheLoad) {
  SceneRun run(scene(kLoad), {"integrator.type=rodas4"});
  const Index a = run.dof("a"), b = run.dof("b");
  Vector v = Vector::Zero(2);
  v[a] = -1.0;
  const time::State state = started(run, Vector::Zero(2), v);
  EXPECT_LT(state.x[a], 0.0);
  EXPECT_GT(state.x[a], -1e-90);
  EXPECT_EQ(state.x[b], 0.0);
  EXPECT_NEAR(state.a[a], -kResidual, 1e-6);
}

TEST(LeaveMiddle, StaysWithoutAForce) {
  SceneRun run(scene(0.0), {"integrator.type=rodas4"});
  const time::State state = started(run, Vector::Zero(2), Vector::Zero(2));
  EXPECT_TRUE(state.x.isZero(0.0));
  EXPECT_TRUE(state.a.isZero(0.0));
}

/// The seven methods of the paper agree with programs written from it (tests/benchmark/plain).
TEST(LeaveMiddle, LeavesThePublishedMethodsAsTheyAre) {
  for (const char* method : {"rk4", "newmark", "newmark_modified"}) {
    SceneRun run(scene(kLoad), {std::string("integrator.type=") + method, "integrator.time_step=1e-3"});
    EXPECT_TRUE(started(run, Vector::Zero(2), Vector::Zero(2)).x.isZero(0.0)) << method;
  }
}

TEST(LeaveMiddle, KeepsStopsWithOneSideAndLinearLaws) {
  for (const char* stop : {"nodes = \"a\"\nsides = \"positive\"", "nodes = \"a\"\nsides = \"negative\""}) {
    SceneRun run(scene(kLoad, stop), {"integrator.type=rodas4"});
    EXPECT_TRUE(started(run, Vector::Zero(2), Vector::Zero(2)).x.isZero(0.0));
  }
  SceneRun run(scene(kLoad), {"integrator.type=rodas4", "contact[0].law=\"linear\"", "contact[0].regularization="});
  EXPECT_TRUE(started(run, Vector::Zero(2), Vector::Zero(2)).x.isZero(0.0));
}

/// In a ring a body leaves the centre along the force on it, by the closed form of a constant force; the residual force
/// acts along its way.
TEST(LeaveMiddle, LeavesTheCentreOfARingAlongTheLoad) {
  constexpr double kAngle = 0.5, kTime = 0.4;
  std::string rings =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[contact]]\ntype = "
      "\"ring\"\nnodes = \"a\"\ngap = 1.0\nlaw = \"arctan\"\nregularization = 1e3\nstiffness = " +
      to_text(kResidual * std::numbers::pi * std::numbers::pi * 1e3) + "\n";
  for (const auto& [dof, part] : {std::pair("uy", std::cos(kAngle)), std::pair("uz", std::sin(kAngle))})
    rings += "[[element]]\ntype = \"spring\"\nnode = \"a\"\ndof = \"" + std::string(dof) +
             "\"\nstiffness = 1e-9\n[[load]]\ntype = \"constant\"\nnode = \"a\"\ndof = \"" + std::string(dof) +
             "\"\nvalue = " + to_text(kLoad * part) + "\n";
  for (const char* method : {"auto", "dopri5", "rodas4", "extrapolation8"}) {
    SceneRun run(rings + "[integrator]\nend_time = " + to_text(kTime) + "\ntolerance = 1e-6\ntype = \"" + method +
                 "\"\n");
    ASSERT_TRUE(run.run().completed) << method << ": " << run.simulation().report().message;
    const double way = 0.5 * (kLoad + kResidual) * kTime * kTime;
    const Vector& x = run.simulation().state().x;
    EXPECT_NEAR(x[run.dof("a", DofKind::uy)], way * std::cos(kAngle), 1e-5 * way) << method;
    EXPECT_NEAR(x[run.dof("a", DofKind::uz)], way * std::sin(kAngle), 1e-5 * way) << method;
  }
}

/// Both nodes have the same displacement, which is moved by a rounding error of it.
TEST(LeaveMiddle, MovesAStopBetweenTwoDisplacedNodes) {
  SceneRun run(scene(kLoad, "between = [\"a\", \"b\"]"), {"integrator.type=rodas4"});
  const Vector x = Vector::Constant(2, 0.1);
  const time::State state = started(run, x, Vector::Zero(2));
  const Index a = run.dof("a"), b = run.dof("b");
  EXPECT_LT(state.x[a] - state.x[b], 0.0);  // the load pulls b away from a
  EXPECT_NEAR(state.x[a], 0.1, 1e-16);
  EXPECT_NEAR(state.a[a], -kResidual, 1e-6);
  EXPECT_NEAR(state.a[b], kLoad + kResidual, 1e-6);
}

}  // namespace
}  // namespace butee::test::departure_test

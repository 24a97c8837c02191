// Wear and the path of the slip in a contact whose dashpot pulls.
#include <cmath>
#include <numbers>
#include <string>

#include <butee/record/contact_recorder.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::wear_test {
namespace {

/// A ball that slides fast along a plane and strikes it; its dashpot may pull before it leaves. Friction, wear and the
/// path of the slip belong to the time in which it presses: with a nearly constant speed W the work is W times the
/// tangential impulse over mu.
TEST(Wear, IsThatOfThePressingForce) {
  constexpr double kSpeed = 100.0, kCoefficient = 0.01;
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode "
      "= \"m\"\ndof = \"uy\"\nstiffness = 1e-9\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = "
      "\"uz\"\nstiffness = 1e-9\n[[contact]]\ntype = \"plane\"\nnodes = \"m\"\nnormal = [1.0, 0.0]\ngap = "
      "1e-3\nstiffness = 1e4\ndamping = { type = \"kelvin_voigt\", coefficient = 60.0, pull = true }\nfriction = "
      "{ coefficient = 0.01, slip_speed = 1e-3 }\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"uy\", value = "
      "1.0 }, { nodes = \"m\", dof = \"uz\", value = 100.0 }]\n[integrator]\ntype = \"dopri5\"\ntolerance = "
      "1e-9\nend_time = 0.1\n");
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  ASSERT_TRUE(run.run().completed);
  ASSERT_EQ(recorder.impacts().size(), 1U);
  const record::Impact impact = recorder.impacts().front();
  const record::ContactWear& wear = recorder.wear().front();
  const double impulse = std::abs(impact.tangential_impulse);
  EXPECT_GT(impulse, 1e-3);
  EXPECT_NEAR(wear.work, kSpeed * impulse / kCoefficient, 1e-3 * wear.work);
  EXPECT_NEAR(wear.slip, impact.slip, 1e-12);
  EXPECT_LT(wear.slip, 0.95 * kSpeed * wear.touching);  // it pulls for a part of the time
}

/// A body on a spring and on the stick spring of a friction support, which stays below its limit: the support slides
/// (as the stretch of its spring counts) by four amplitudes a period, with reversals within the steps.
TEST(Wear, CountsBothDirectionsOfASlipThatReversesInAStep) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 3000.0\n[[contact]]\ntype = \"friction\"\nnodes = \"m\"\ndof = \"u\"\nnormal_force = "
      "100.0\nfriction = { coefficient = 0.5, stick_stiffness = 1000.0 }\n[initial]\ndisplacement = [{ nodes = \"m\", "
      "value = 0.01 }]\n[integrator]\ntolerance = 1e-6\nend_time = 1.0\n";
  const double omega = std::sqrt(4000.0), amplitude = 0.0075, half_periods = std::floor(omega / std::numbers::pi),
               slip = amplitude * (2.0 * half_periods + 1.0 - std::cos(omega - half_periods * std::numbers::pi));
  for (const std::string method : {"exact", "exponential", "dopri5", "rodas4"}) {
    SceneRun run(scene, {"integrator.type=" + method});
    record::ContactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_NEAR(recorder.wear()[0].slip, slip, 1e-6 * slip) << method;
    EXPECT_NEAR(recorder.wear()[0].work, 100.0 * slip, 1e-4 * slip) << method;
  }
}

/// A slip that reverses within the few instants that two doubles near t leave: the search for it ends.
TEST(Wear, IsFoundWhereASlipReversesWithinInstants) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 100.0\n[[contact]]\ntype = \"friction\"\nnodes = \"m\"\nnormal_force = 1.0\nfriction = { "
      "coefficient = 1e-16, slip_speed = 1.0 }\n[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [0.0, "
      "9.595778328944998, 9.595778328951715, 9.595778329040956, 10.595778328944998]\nvalues = [0.0, 0.0, 1.0, -2.0, "
      "0.0]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-6\nend_time = 10.0\n");
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  ASSERT_TRUE(run.run().completed);
  EXPECT_GT(recorder.wear()[0].slip, 0.0);
}

/// Pipes at rest on rings, whose slip is rounding of both signs: the search for reversals once never ended.
TEST(Wear, IsFoundOnAPipeThatRestsOnItsRings) {
  SceneRun run(
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7850.0\n[section.p]\nshape = \"tube\"\nouter_radius = "
      "0.05\ninner_radius = 0.03\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmotion = \"lateral\"\nmaterial = "
      "\"s\"\nsection = \"p\"\nlength = 20.0\nelements = 6\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = "
      "[\"uy\", \"uz\"]\n[[contact]]\ntype = \"ring\"\nnodes = \"b:1..5\"\ngap = 0.005\nstiffness = 2e4\nfriction = { "
      "coefficient = 0.3, slip_speed = 0.02 }\n[[load]]\ntype = \"harmonic\"\nnode = \"b:2\"\ndof = \"uz\"\namplitude "
      "= "
      "4.0\nangular_frequency = 300.0\n[damping]\nmass_proportional = 1.0\n[gravity]\nacceleration = [0.0, -9.81, "
      "0.0]\nstatic = true\n[integrator]\ntype = \"exponential\"\nend_time = 0.2\n");
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  ASSERT_TRUE(run.run().completed);
  for (const record::ContactWear& wear : recorder.wear()) EXPECT_GT(wear.slip, 0.0);
}

}  // namespace
}  // namespace butee::test::wear_test

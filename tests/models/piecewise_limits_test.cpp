// piecewise in limits with a closed form, at contact boundaries, from snapshots, and its refusals.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <butee/core/error.hpp>
#include <gtest/gtest.h>

#include "models/piecewise_scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::test::piecewise_limits_test {
namespace {

TEST(Piecewise, RefusesOtherScenesBeforeTheFirstStep) {
  const std::string scene = one_mass(0.0);
  const auto message_of = [](const std::string& toml, const std::vector<std::string>& overrides) -> std::string {
    try {
      SceneRun run(toml, overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(message_of(scene, {}), "taken");
  EXPECT_NE(message_of(scene, {"contact[0].law=arctan", "contact[0].regularization=7e7"}).find("law = \"linear\""),
            std::string::npos);
  EXPECT_NE(message_of(with_linear_law("beam1"), {"integrator.type=piecewise"}).find("68 DOFs are more than the 24"),
            std::string::npos);
  EXPECT_NE(message_of(scene, {"contact[0].damping={type=\"hunt_crossley\",factor=0.1}"}).find("Kelvin-Voigt"),
            std::string::npos);
  // (s^2 + s + 1.25)(s^2 + 1) - 0.25 = (s^2 + s/2 + 1)^2: two masses whose motions coincide.
  EXPECT_NE(message_of("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = "
                       "\"mass\"\nname = \"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", "
                       "\"b\"]\nstiffness = 0.5\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = "
                       "0.75\ndamping = 1.0\n[[element]]\ntype = \"spring\"\nnode = \"b\"\nstiffness = 0.5\n"
                       "[integrator]\ntype = \"piecewise\"\nend_time = 1.0\n",
                       {})
                .find("critical damping"),
            std::string::npos);
}

/// A bearing whose damping is negative along u: u = e^(t/4) sin(w t)/w from u' = 1 until it strikes, w^2 = 100 - 1/16.
TEST(Piecewise, LeavesGrowingMotionToOtherMethods) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\nnode = "
      "\"m\"\nstiffness = [[100.0, 0.0], [0.0, 144.0]]\ndamping = [[-0.5, 0.0], [0.0, 0.3]]\n[[contact]]\ntype = "
      "\"stop\"\nnodes = \"m\"\ngap = 0.2\nstiffness = 400.0\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"u\", "
      "value = 1.0 }]\n[integrator]\ntolerance = 1e-6\nend_time = 2.0\n";
  for (const char* damping : {"[[-0.5, 0.0], [0.0, 0.3]]", "[[-0.5, 0.4], [0.4, 0.3]]"}) {
    try {
      SceneRun run(scene, {"integrator.type=piecewise", std::string("element[1].damping=") + damping});
      FAIL() << damping << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("negative damping"), std::string::npos) << error.what();
    }
  }
  // Damping of one direction alone neither grows nor decays along the other one.
  EXPECT_NO_THROW(SceneRun(scene, {"integrator.type=piecewise", "element[1].damping=[[0.1, 0.1], [0.1, 0.1]]"}));
  const double w = std::sqrt(100.0 - 0.0625);
  for (const std::string method : {"auto", "exponential", "rodas4"}) {
    SceneRun run(scene, {"integrator.type=" + method});
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_NEAR(run.simulation().state().x[run.dof("m")], std::exp(0.5) * std::sin(2.0 * w) / w, 1e-6) << method;
  }
  // One DOF that runs away without oscillation: x'' - 3 x' + x = 0.
  const std::vector<std::string> alone = {"element[1].stiffness=[[1.0, 0.0], [0.0, 1.0]]",
                                          "element[1].damping=[[-3.0, 0.0], [0.0, 0.0]]", "contact[0].gap=10.0",
                                          "integrator.end_time=1.0"};
  const double root = std::sqrt(1.25), u = std::exp(1.5) * std::sinh(root) / root;
  for (const std::string method : {"auto", "exponential", "rodas4"}) {
    std::vector<std::string> overrides = alone;
    overrides.push_back("integrator.type=" + method);
    SceneRun run(scene + "[[support]]\nnodes = \"m\"\nfix = [\"uz\"]\n", overrides);
    ASSERT_EQ(run.dynamics().size(), 1);
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_NEAR(run.simulation().state().x[0], u, 1e-5 * u) << method;
  }
}

/// x'' + omega^2 x = f cos(omega t) from rest is f t sin(omega t)/(2 omega). So close to resonance, the usual
/// closed form of forced motion would lose all digits.
TEST(Piecewise, FollowsResonance) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 9.0\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 2.0\n[integrator]\ntype = "
      "\"piecewise\"\nend_time = 50.0\n";
  for (const double detuning : {0.0, 1e-13, 1e-9, 1e-6, 1e-4, 1e-2}) {
    const double omega = 3.0 * (1.0 + detuning);
    SceneRun run(scene, {"load[0].angular_frequency=" + to_text(omega)});
    ASSERT_TRUE(run.run().completed);
    // 2 sin(a) sin(b)/((omega - 3)(omega + 3)) with the half difference and sum of the phases.
    const long double half = 0.5L * 3.0L * detuning * 50.0L, sum = 3.0L * 50.0L + half;
    const long double beat = half == 0.0L ? 1.0L : std::sin(half) / half;
    const long double x = 2.0L * 50.0L * beat * std::sin(sum) / (static_cast<long double>(omega) + 3.0L);
    // The largest error is the rounding of the load's frequency: 50 omega eps in the phase.
    EXPECT_NEAR(run.simulation().state().x[0], static_cast<double>(x), 2e-12 * 50.0) << detuning;
  }
}

/// A damped mass under a load: each of 25 000 turns has its part in the work.
TEST(Piecewise, ResolvesAsManyTurnsAsARunHas) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 1e6\ndamping = 0.02\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = "
      "1.0\nangular_frequency = 999.98\n[integrator]\ntype = \"piecewise\"\nend_time = 160.0\n");
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(energy);
  ASSERT_TRUE(run.run().completed);
  EXPECT_NEAR(energy.balance_error(), 0.0, 1e-9);
}

/// A free mass under a constant force strikes a stop; damping is so small that m g/c is a million times its
/// path.
TEST(Piecewise, FallsFreelyWithNextToNoDamping) {
  for (const double rate : {0.0, 1e-12, 1e-6, 1e-3, 10.0}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[load]]\ntype = "
        "\"constant\"\nnode = \"m\"\nvalue = -20.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = "
        "100.0\nlaw = \"linear\"\nstiffness = 1e6\n[damping]\nmass_proportional = " +
        to_text(rate) + "\n[integrator]\ntype = \"piecewise\"\nend_time = 3.0\n");
    ASSERT_TRUE(run.run().completed);
    const long double c = rate, t = 3.0L;
    // x = -g (t - (1 - e^(-c t))/c)/c, or its series for small c.
    const long double x = rate < 1e-4 ? -10.0L * t * t * (0.5L - c * t / 6.0L + c * c * t * t / 24.0L)
                                      : -10.0L * (t + std::expm1(-c * t) / c) / c;
    EXPECT_NEAR(run.simulation().state().x[0] / static_cast<double>(x), 1.0, 1e-13) << rate;
  }
}

/// A start at rest exactly at the gap: the first nonzero derivative decides the contact status.
TEST(Piecewise, DecidesStartsOnTheBorder) {
  for (const char* load : {"type = \"constant\"\nvalue = 3.0\n", "type = \"constant\"\nvalue = -3.0\n",
                           "type = \"ramp\"\nto = 3.0\nend = 0.5\n", "type = \"ramp\"\nto = -3.0\nend = 0.5\n",
                           "type = \"constant\"\nvalue = 0.0\n"}) {
    const std::string scene =
        std::string(
            "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = "
            "\"stop\"\nnodes = \"m\"\ngap = 0.125\nsides = \"positive\"\nlaw = \"linear\"\nstiffness = "
            "1e4\n[initial]\ndisplacement = [{ nodes = \"m\", value = 0.125 }]\n[[load]]\nnode = \"m\"\n") +
        load + "[integrator]\nend_time = 0.9\n";
    SceneRun ours(scene, {"integrator.type=piecewise"}), reference(scene, {"integrator.type=exact"});
    ASSERT_TRUE(ours.run().completed);
    ASSERT_TRUE(reference.run().completed);
    EXPECT_NEAR(ours.simulation().state().x[0], reference.simulation().state().x[0], 1e-13) << load;
    EXPECT_LT(ours.simulation().report().steps, 200) << load;
  }
}

/// The end of a chain at rest touches a stop; a load at its other end sets it in motion as t^9, away from the stop.
/// Every derivative rises out of its rounding error in turn.
TEST(Piecewise, LeavesAStopAsSlowlyAsAChainBegins) {
  std::string scene = "schema = 1\n";
  for (int i = 0; i < 4; ++i) {
    const std::string name = "m" + std::to_string(i);
    scene += "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + (i < 3 ? "1.5" : "0.015") + "\n";
    scene +=
        "[[element]]\ntype = \"spring\"\n" +
        (i == 0 ? std::string("node = \"m0\"\n") : "nodes = [\"m" + std::to_string(i - 1) + "\", \"" + name + "\"]\n") +
        "stiffness = 1.2e4\n";
  }
  scene +=
      "[[contact]]\ntype = \"stop\"\nnodes = \"m0\"\ngap = 0.0\nsides = \"negative\"\nlaw = \"linear\"\nstiffness = "
      "1e9\n[[load]]\nnode = \"m3\"\ntype = \"ramp\"\nto = 62.0\nstart = 0.0085\nend = 0.0095\n[integrator]\nend_time "
      "= "
      "0.2\n";
  SceneRun ours(scene, {"integrator.type=piecewise"}), reference(scene, {"integrator.type=exact"});
  ASSERT_TRUE(ours.run().completed);
  ASSERT_TRUE(reference.run().completed);
  EXPECT_LT(ours.simulation().report().steps, 200);
  EXPECT_LT((ours.simulation().state().x - reference.simulation().state().x).norm(),
            1e-10 * reference.simulation().state().x.norm());
}

/// A dashpot of the closed stop makes two motions of two masses coincide: a double root of
/// (s^2 + c s + 12000)(s^2 + 2000) - 1e6, found with 50 digits.
TEST(Piecewise, EndsWhereAContactStateHasNoModes) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 1e3\n[[element]]\ntype = "
      "\"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 1e3\n[[element]]\ntype = \"spring\"\nnode = "
      "\"b\"\nstiffness = 1e3\n[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 0.1\nlaw = "
      "\"linear\"\nstiffness = 1e4\ndamping = { type = \"kelvin_voigt\", coefficient = 218.42967342546443 }\n"
      "[initial]\nvelocity = [{ nodes = \"a\", value = 10.0 }]\n[integrator]\ntype = \"piecewise\"\nend_time = "
      "1.0\n";
  SceneRun run(scene), reference(scene, {"integrator.type=exact"});
  Sampler last(0, {0.005, 0.01});
  run.simulation().add(last);
  EXPECT_FALSE(run.run().completed);
  const time::RunReport& report = run.simulation().report();
  EXPECT_NE(report.message.find("critical damping"), std::string::npos) << report.message;
  // Up to the closing there is a result.
  EXPECT_NEAR(run.simulation().state().x[0], 0.1, 1e-14);
  EXPECT_GT(report.t_end, 0.01);
  EXPECT_EQ(last.x.size(), 2u);
  EXPECT_TRUE(reference.run().completed);
}

/// Soft springs with stiffness-proportional damping beside a stop that is 1e9 times stiffer: slow motions of modes
/// that damping couples are no defective ones.
TEST(Piecewise, TakesSlowMotionsBesideStiffStops) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 2e-4\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 0.8\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 150.0\n[[element]]\ntype = "
      "\"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 30.0\n[[contact]]\ntype = \"stop\"\nbetween = [\"a\", "
      "\"b\"]\ngap = 1e-3\nlaw = \"linear\"\nstiffness = 5e10\n[damping]\nstiffness_proportional = 1e-4\n"
      "[initial]\nvelocity = [{ nodes = \"b\", value = 0.1 }]\n[integrator]\nend_time = 0.05\n";
  SceneRun ours(scene, {"integrator.type=piecewise"}), reference(scene, {"integrator.type=exact"});
  ASSERT_TRUE(ours.run().completed) << ours.simulation().report().message;
  ASSERT_TRUE(reference.run().completed);
  // omega^2 of the slow motions is known to 1e-18 of the largest, 2.5e14 (piecewise.md), thus to 3e-4. During 199
  // impacts, 4e-5 s in all, this changes the speed by 6e-11 m/s at 5 mm, and the displacement at the end by 2e-12 m.
  constexpr double kOfFrequencies = 1e-11;
  EXPECT_NEAR(ours.simulation().state().x[1], reference.simulation().state().x[1], kOfFrequencies);
}

/// Compares the speeds of more than `least` impacts with those of `exact`; the first one may begin at the start.
/// Returns the evaluations of gaps.
std::int64_t expect_impacts_of_exact(const std::string& scene, std::size_t least, double tolerance) {
  SceneRun ours(scene, {"integrator.type=piecewise"}), reference(scene, {"integrator.type=exact"});
  record::ImpactRecorder found(ours.dynamics()), expected(reference.dynamics());
  ours.simulation().add(found);
  reference.simulation().add(expected);
  EXPECT_TRUE(ours.run().completed) << ours.simulation().report().message;
  EXPECT_TRUE(reference.run().completed);
  const auto impacts = found.impacts(), wanted = expected.impacts();
  EXPECT_EQ(impacts.size(), wanted.size());
  EXPECT_GT(wanted.size(), least);
  for (std::size_t i = 1; i < std::min(impacts.size(), wanted.size()); ++i)
    EXPECT_NEAR(impacts[i].impact_speed, wanted[i].impact_speed, tolerance * wanted[i].impact_speed) << i;
  return ours.dynamics().counters().law_evaluations;
}

/// A body of 15 ug between a load and a soft spring: where it is free, its static displacement is 7600 gaps, so that
/// the instant of impact is known less precisely than the closed state requires.
TEST(Piecewise, KeepsTheSpeedOfLightBodiesUnderALoad) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 2.17\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\nstiffness = 4123.0\n[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = "
      "1.4830322061418124e-08\n[[element]]"
      "\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 3.5430823988573703\n[[contact]]\ntype = "
      "\"stop\"\nbetween = [\"a\", \"b\"]\ngap = 0.007491315464643473\nstiffness = 157973.4506180764\nsides = "
      "\"negative\"\nlaw = \"linear\"\n[[load]]\ntype = \"constant\"\nnode = \"b\"\nvalue = "
      "203.019636832086\n[damping]\n"
      "stiffness_proportional = 2.842130962565534e-06\n[initial]\ndisplacement = [{ nodes = \"b\", value = "
      "0.010572645698081399 }]\n[integrator]\nend_time = 2e-4\n";
  // Rounding of 57 m, the static displacement, in the gap: 1e-12 of it at each impact.
  expect_impacts_of_exact(scene, 90, 1e-9);
}

/// A body of 13 mg between two stops of unlike stiffness that both touch it, at rest under a load: it changes from one
/// stop to the other at one place, also at the first instant. Outputs follow no step a second time.
TEST(Piecewise, ChangesFromOneStopToAnotherAtOnePlace) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m0\"\nmass = 0.6209571352177292\n[[element]]\ntype = "
      "\"spring\"\nnode = \"m0\"\nstiffness = 3891.3402048809926\n[[element]]\ntype = \"mass\"\nname = \"m1\"\nmass = "
      "1.2870843983115148e-05\n[[element]]\ntype = \"spring\"\nnodes = [\"m0\", \"m1\"]\nstiffness = "
      "46.93078642218467\n[[contact]]\ntype = \"stop\"\nnodes = \"m1\"\ngap = 0.0\nstiffness = "
      "1968967.0651463151\nsides = \"negative\"\nlaw = \"linear\"\n[[contact]]\ntype = \"stop\"\nnodes = \"m1\"\ngap = "
      "0.0\nstiffness = 59877.421419501545\nsides = \"positive\"\nlaw = \"linear\"\n[[load]]\nnode = \"m1\"\ntype = "
      "\"unbalance\"\nmoment = 0.0034773535837518145\nspeed = 74.60147925767838\nphase = "
      "4.088946566772782\n[damping]\nstiffness_proportional = 1.6651104583916507e-06\n[integrator]\nend_time = 2e-2\n";
  // Rounding of 0.3 m, where the body would rest without stops, in the instants of the changes.
  EXPECT_LT(expect_impacts_of_exact(scene, 400, 1e-8), 100000);
}

/// A body swings on a spring against a far lighter one that a stop holds: omega^2 = 44 1/s2 beside 3.7e18 1/s2 of the
/// light one on the stop, whose rounding in extended precision is 0.4 1/s2.
TEST(Piecewise, KeepsASoftSpringBesideAHardStop) {
  const double mass = 0.5, stiffness = 22.0, speed = 1.0, end = 0.4;
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"light\"\nmass = 2.7e-8\n[[element]]\ntype = \"mass\"\nname = "
      "\"body\"\nmass = 0.5\n[[element]]\ntype = \"spring\"\nnodes = [\"light\", \"body\"]\nstiffness = 22.0\n"
      "[[contact]]\ntype = \"stop\"\nnodes = \"light\"\ngap = 0.0\nstiffness = 1e11\nsides = \"positive\"\nlaw = "
      "\"linear\"\n[initial]\nvelocity = [{ nodes = \"body\", value = 1.0 }]\n[integrator]\ntype = "
      "\"piecewise\"\nend_time = 0.4\n";
  SceneRun run(scene);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double omega = std::sqrt(stiffness / mass);
  const time::State& state = run.simulation().state();
  EXPECT_NEAR(state.x[run.dof("body")], speed / omega * std::sin(omega * end), 1e-8);
  EXPECT_NEAR(state.v[run.dof("body")], speed * std::cos(omega * end), 1e-8);
}

/// A run with other step ends (other outputs), and one that resumes in the middle.
TEST(Piecewise, GoesOnFromASnapshotToTheSameBits) {
  const std::string scene = one_mass(50.0);
  SceneRun whole(scene), parts(scene, {"integrator.end_time=0.4"});
  ASSERT_TRUE(whole.run().completed);
  parts.simulation().set_end_time(0.4);
  ASSERT_TRUE(parts.run().completed);
  EXPECT_TRUE(whole.simulation().state().x == parts.simulation().state().x);
}

}  // namespace
}  // namespace butee::test::piecewise_limits_test

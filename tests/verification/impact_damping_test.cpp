// Dissipative impacts compared with closed forms of the restitution and of the largest penetration.
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/record/contact_recorder.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::impact_damping_test {
namespace {

struct Outcome {
  double restitution, impulse_time, peak_force, dissipated;
};

/// A mass moves at `speed` against a stop on its positive side.
Outcome bounce(double mass, double speed, const std::string& contact, double end_time, const std::string& method) {
  char start[400];
  std::snprintf(
      start, sizeof start,
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = %.17g\n[initial]\nvelocity = [{ nodes = "
      "\"ball\", value = %.17g }]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-11\nend_time = %.17g\n",
      mass, speed, end_time);
  SceneRun run(start + ("[[contact]]\ntype = \"stop\"\nsides = \"positive\"\nnodes = \"ball\"\n" + contact), {method});
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
  const auto impacts = recorder.impacts();
  EXPECT_EQ(impacts.size(), 1U);
  if (impacts.empty() || !impacts[0].t_out) return {};
  return {-run.simulation().state().v[0] / speed, *impacts[0].t_out - impacts[0].t_in, impacts[0].peak_force,
          impacts[0].dissipated};
}

class ImpactMethods : public testing::TestWithParam<const char*> {};

/// C1: m = 1, k = 1e4: the contact ends at F = 0, or at g = 0 if it may pull.
TEST_P(ImpactMethods, KelvinAndVoigtsDashpotGivesItsRestitution) {
  struct Row {
    double zeta, pulls, released;
  };
  for (const Row row : {Row{0.05, 0.8544678930, 0.8587581018},
                        {0.1, 0.7292476143, 0.7440793977},
                        {0.2, 0.5266205993, 0.5717400276},
                        {0.5, 0.1630335348, 0.2984360592}}) {
    const std::string law = "gap = 1e-3\nstiffness = 1e4\ndamping = { type = \"kelvin_voigt\", coefficient = " +
                            std::to_string(200.0 * row.zeta);
    EXPECT_NEAR(bounce(1.0, 1.0, law + ", pull = true }\n", 0.3, GetParam()).restitution, row.pulls, 1e-9);
    const Outcome released = bounce(1.0, 1.0, law + " }\n", 0.3, GetParam());
    EXPECT_NEAR(released.restitution, row.released, 1e-9);
    EXPECT_NEAR(released.dissipated, 0.5 * (1.0 - row.released * row.released), 1e-8);
    // Contact ends where k g + c g' = 0, before g = 0.
    const double root = std::sqrt(1.0 - row.zeta * row.zeta);
    const double turn = std::numbers::pi - std::atan2(2.0 * row.zeta * root, 1.0 - 2.0 * row.zeta * row.zeta);
    EXPECT_NEAR(released.impulse_time, turn / (100.0 * root), 1e-9);
  }
}

TEST_P(ImpactMethods, AWantedRestitutionComesOut) {
  for (const double e : {0.4, 0.8, 0.95}) {
    const std::string number = "restitution = " + std::to_string(e);
    const std::string law = "gap = 1e-3\nstiffness = 1e4\ndamping = { type = \"kelvin_voigt\", mass = 2.0, " + number;
    EXPECT_NEAR(bounce(2.0, 1.0, law + ", pull = true }\n", 0.5, GetParam()).restitution, e, 1e-9);
    EXPECT_NEAR(bounce(2.0, 1.0, law + " }\n", 0.5, GetParam()).restitution, e, 1e-9);
  }
}

/// C2: s (1 + e) = ln((1 + s)/(1 - s e)) with s = a v_i, for any n, k and m.
TEST_P(ImpactMethods, HuntAndCrossleysLawGivesItsRestitution) {
  for (const auto& [s, e] : {std::pair(0.1, 0.937475579950), {0.5, 0.748434931597}, {2.0, 0.410719686061}})
    for (const char* law : {"law = \"hertz\"\nstiffness = 1e8\n", "stiffness = 1e5\n"}) {
      const std::string contact = std::string("gap = 1e-3\n") + law +
                                  "damping = { type = \"hunt_crossley\", factor = " + std::to_string(s / 0.5) + " }\n";
      EXPECT_NEAR(bounce(2.0, 0.5, contact, 0.1, GetParam()).restitution, e, 1e-9) << s << " " << law;
    }
  const std::string wanted =
      "gap = 1e-3\nlaw = \"hertz\"\nstiffness = 1e8\ndamping = { type = \"hunt_crossley\", restitution = 0.65, "
      "impact_speed = 0.5 }\n";
  EXPECT_NEAR(bounce(2.0, 0.5, wanted, 0.1, GetParam()).restitution, 0.65, 1e-9);
}

/// C3: a steel ball of 10 mm on steel at 1 m/s.
TEST_P(ImpactMethods, HertzLawHasTheDurationAndForceOfItsClosedForm) {
  const Outcome ball = bounce(0.0326725636, 1.0,
                              "gap = 1e-5\nlaw = \"hertz\"\nstiffness = 1.5384615385e10\n"
                              "damping = { type = \"hunt_crossley\", factor = 0.0 }\n",
                              1e-4, GetParam());
  EXPECT_NEAR(ball.restitution, 1.0, 1e-9);
  EXPECT_NEAR(ball.impulse_time, 6.8934003430e-5, 1e-8 * 6.9e-5);
  EXPECT_NEAR(ball.peak_force, 1743.7755835, 1e-8 * 1743.8);
}

/// C4: the restitution that results from Jankowski's approximate formula.
TEST_P(ImpactMethods, JankowskisLawGivesTheRestitutionThatTheMessageStates) {
  for (const auto& [wanted, real] : {std::pair(0.5, 0.4945878), {0.65, 0.6470290}, {0.8, 0.7989438}}) {
    const std::string contact =
        "gap = 1e-3\nlaw = \"hertz\"\nstiffness = 1e8\ndamping = { type = \"jankowski\", mass = 2.0, restitution = " +
        std::to_string(wanted) + " }\n";
    EXPECT_NEAR(bounce(2.0, 0.5, contact, 0.1, GetParam()).restitution, real, 1e-7);
  }
}

/// The dashpot of jankowski has infinite slope when the contact closes; Rosenbrock's stages cannot resolve
/// it.
TEST(Jankowski, IsRefusedByRodas4AndTakenByAuto) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 2.0\n[[contact]]\ntype = \"stop\"\nnodes = "
      "\"ball\"\ngap = 1e-3\nlaw = \"hertz\"\nstiffness = 1e8\ndamping = { type = \"jankowski\", mass = 2.0, "
      "restitution = 0.5 }\n[initial]\nvelocity = [{ nodes = \"ball\", value = 0.5 }]\n[integrator]\nend_time = 0.01\n";
  try {
    SceneRun refused(scene, {"integrator.type=rodas4"});
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("these can: auto, dopri5"), std::string::npos) << error.what();
  }
  SceneRun chosen(scene);
  EXPECT_TRUE(chosen.run().completed);
}

/// The peak of normal_force in a summary includes motion between rows and steps, and equals that in wear.csv:
/// an elastic impact of m = 2 at k = 1e6 with 0.5 m/s gives v sqrt(k m).
/// Two masses on springs that pound: the slope of the dissipation is infinite where they meet. The steps of exponential
/// are short there and grow again; they stayed as short for the whole contact (1664 steps).
TEST(Jankowski, NeedsFewStepsOfExponential) {
  const std::string springs =
                        "[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 100.0\n[[element]]\ntype = "
                        "\"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 300.0\n",
                    contact =
                        "[[contact]]\ntype = \"stop\"\nbetween = [\"a\", \"b\"]\ngap = 0.01\nlaw = "
                        "\"hertz\"\nstiffness = 1e7\ndamping = { type = \"jankowski\", restitution = 0.6, mass = "
                        "0.67 }\n",
                    load = "[[load]]\ntype = \"harmonic\"\nnode = \"a\"\namplitude = 5.0\nangular_frequency = 9.0\n";
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = "
      "\"mass\"\nname = \"b\"\nmass = 2.0\n" +
      springs + contact + load + "[integrator]\nend_time = 1.0\n";
  const auto end_of = [&](const char* method, const char* tolerance, Vector& x) {
    SceneRun run(scene, {std::string("integrator.type=") + method, std::string("integrator.tolerance=") + tolerance});
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    x = run.simulation().state().x;
    return run.simulation().report().steps;
  };
  Vector expected, found;
  end_of("extrapolation8", "1e-10", expected);
  EXPECT_LT(end_of("exponential", "1e-5", found), 800);
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
}

TEST_P(ImpactMethods, ThePeakOfTheNormalForceIsFoundBetweenRows) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\n"
      "node = \"ball\"\ndof = \"uz\"\nstiffness = 1e-9\n[[contact]]\ntype = \"ring\"\nnodes = \"ball\"\n"
      "gap = 1e-3\nstiffness = 1e6\n[initial]\nvelocity = [{ nodes = \"ball\", dof = \"uy\", value = 0.3 }, "
      "{ nodes = \"ball\", dof = \"uz\", value = 0.4 }]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-9\n"
      "end_time = 0.02\n",
      {GetParam()});
  model::OutputRequest request;
  request.interval = 0.02;
  const auto node = run.model().nodes.select("ball").nodes.front();
  request.probes = {{"p", node, {model::Quantity::contact_normal, model::Quantity::contact_force}, ""}};
  record::HistoryRecorder history(request, 0.02, run.dynamics(), nullptr);
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(history);
  run.simulation().add(recorder);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double peak = 0.5 * std::sqrt(2e6);
  EXPECT_NEAR(history.peaks().at("p.normal_force"), peak, 1e-8 * peak);
  EXPECT_NEAR(history.peaks().at("p.contact_force"), 0.6 * peak, 1e-8 * peak);
  EXPECT_NEAR(recorder.wear()[0].peak_force, peak, 1e-8 * peak);
  EXPECT_NEAR(recorder.impacts().at(0).peak_force, peak, 1e-8 * peak);
}

/// A start far within a stop: by Hunt and Crossley the body soon moves at -1/factor, where the force is 0, and is at
/// x_0 - t/factor + m/(k x_0 factor^2) but for terms of higher order.
class FarOverlap : public testing::TestWithParam<const char*> {};

TEST_P(FarOverlap, LeavesAtTheSpeedWithoutForceInFewSteps) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nsides = "
      "\"positive\"\nnodes = \"ball\"\ngap = 0.0\nstiffness = 1e4\ndamping = { type = \"hunt_crossley\", factor = 5.0 "
      "}\n"
      "[initial]\ndisplacement = [{ nodes = \"ball\", value = 0.5 }]\n[integrator]\ntolerance = 1e-5\nend_time = "
      "20.0\n",
      {GetParam()});
  const time::RunReport& report = run.run();
  ASSERT_TRUE(report.completed) << report.message;
  EXPECT_NEAR(run.simulation().state().x[0], 0.5 - 4.0 + 8e-6, 1e-6);
  EXPECT_NEAR(run.simulation().state().v[0], -0.2, 1e-6);
  EXPECT_LT(report.steps, 2000);
}

INSTANTIATE_TEST_SUITE_P(Methods, FarOverlap,
                         testing::Values("integrator.type=exponential", "integrator.type=rodas4",
                                         "integrator.type=extrapolation8", "integrator.type=auto"));

/// The middle of a symmetric beam under a moment there moves by rounding alone; its stop changes nothing.
TEST(SymmetricBeam, DoesNotTouchTheDissipativeStopInItsMiddle) {
  const std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7800.0\n[section.t]\nshape = \"tube\"\nouter_radius "
      "= "
      "0.02\ninner_radius = 0.015\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = "
      "\"t\"\nlength = 2.0\n"
      "elements = 6\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n[[load]]\ntype = \"table\"\nnode = "
      "\"b:middle\"\ndof = \"theta\"\ntimes = [0.0, 0.1, 0.1001, 0.1002]\nvalues = [0.0, 0.0, 1e4, 0.0]\n[integrator]\n"
      "type = \"exponential\"\ntolerance = 1e-5\nend_time = 0.2\n";
  SceneRun free(scene);
  SceneRun stopped(
      scene +
      "[[contact]]\ntype = \"stop\"\nsides = \"positive\"\nnodes = \"b:middle\"\ngap = 0.0\nstiffness = 1e9\n"
      "damping = { type = \"kelvin_voigt\", coefficient = 1e5 }\n");
  ASSERT_TRUE(free.run().completed);
  const time::RunReport& report = stopped.run();
  ASSERT_TRUE(report.completed) << report.message;
  EXPECT_LT(report.steps, 3000);
  const Vector &x = free.simulation().state().x, &y = stopped.simulation().state().x;
  EXPECT_GT(x.lpNorm<Eigen::Infinity>(), 0.01);
  EXPECT_LT((x - y).lpNorm<Eigen::Infinity>(), 1e-4 * x.lpNorm<Eigen::Infinity>());
}

/// A pair of dissipative stops: every method finds the same motion, without a gap as well, and impacts.csv names the
/// side that is touched.
class PairOfStops : public testing::TestWithParam<double> {};

TEST_P(PairOfStops, IsOneContactForAllMethodsAndNamesItsSides) {
  const auto scene = [](double gap) {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes "
           "= "
           "\"ball\"\ngap = " +
           std::to_string(gap) +
           "\nstiffness = 1e4\ndamping = { type = \"hunt_crossley\", factor = 0.5 }\n[[load]]\ntype = "
           "\"harmonic\"\nnode = "
           "\"ball\"\namplitude = 1.0\nangular_frequency = 10.0\n[integrator]\ntype = \"exact\"\nend_time = 1.0\n";
  };
  SceneRun exact(scene(GetParam()));
  record::ContactRecorder recorder(exact.dynamics());
  exact.simulation().add(recorder);
  ASSERT_TRUE(exact.run().completed) << exact.simulation().report().message;
  const double x = exact.simulation().state().x[0];
  for (const std::string method : {"rodas4", "dopri5", "extrapolation8", "exponential"}) {
    SceneRun other(scene(GetParam()), {"integrator.type=" + method, "integrator.tolerance=1e-8"});
    ASSERT_TRUE(other.run().completed) << method << ": " << other.simulation().report().message;
    EXPECT_NEAR(other.simulation().state().x[0], x, 1e-10) << method;
  }
  bool positive = false, negative = false;
  for (const record::Impact& impact : recorder.impacts()) {
    (impact.side > 0 ? positive : negative) = true;
    const double middle = impact.t_out ? 0.5 * (impact.t_in + *impact.t_out) : 1.0;
    SceneRun again(scene(GetParam()), {"integrator.end_time=" + std::to_string(middle)});
    ASSERT_TRUE(again.run().completed);
    EXPECT_GT(impact.side * again.simulation().state().x[0], GetParam()) << "at " << middle << " s";
  }
  EXPECT_TRUE(positive && negative);
}

INSTANTIATE_TEST_SUITE_P(Gaps, PairOfStops, testing::Values(0.0, 1e-3));

/// A ball that falls on a hard stop strikes it with at most v sqrt(k m) plus the force of the dashpot, for as long as
/// half a period. L-stable methods damp the motion in the contact in one step if it is long: one of 0.3 s showed an
/// error estimate below the tolerance, and the ball sank in by 50 times the true depth.
TEST(HardImpact, IsResolvedFromItsFirstStepOn) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
      "\"m\"\ngap = 0.1\nsides = \"negative\"\nstiffness = 1e6\ndamping = { type = \"kelvin_voigt\", coefficient = "
      "30.0 }\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = -9.81\n[integrator]\ntype = \"rodas4\"\n"
      "tolerance = 1e-3\nend_time = 6.0\n";
  const double speed = std::sqrt(2.0 * 9.81 * 0.1);
  for (const double k : {1e6, 1e7})
    for (const double c : {10.0, 30.0, 60.0, 100.0})
      for (const std::string tolerance : {"1e-2", "1e-3", "1e-4"}) {
        SceneRun run(scene, {"contact[0].stiffness=" + to_text(k), "contact[0].damping.coefficient=" + to_text(c),
                             "integrator.tolerance=" + tolerance});
        record::ContactRecorder recorder(run.dynamics());
        run.simulation().add(recorder);
        ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
        const std::string where = tolerance + ", " + to_text(k) + ", " + to_text(c);
        ASSERT_GT(recorder.impacts().size(), 3U) << where;
        for (const record::Impact& impact : recorder.impacts()) {
          EXPECT_LT(impact.peak_force, 1.1 * speed * std::sqrt(k) + c * speed) << where << " at " << impact.t_in;
          if (std::abs(impact.impact_speed) > 0.1 * speed && impact.t_out) {
            EXPECT_LT(*impact.t_out - impact.t_in, 6.0 / std::sqrt(k)) << where << " at " << impact.t_in;
          }
        }
      }
}

/// The largest force of an impact that a step begins or ends close to, by Dormand and Prince's method of order 8
/// (scipy, rtol = 1e-13, events).
TEST(HardImpact, HasItsPeakAlsoBesideTheEndsOfSteps) {
  const double wanted = 25886.1628696;
  for (const std::string method : {"exponential", "dopri5", "rodas4", "extrapolation8"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
        "\"m\"\ngap = 0.01\nsides = \"negative\"\nlaw = \"hertz\"\nstiffness = 1e10\ndamping = { type = "
        "\"hunt_crossley\", factor = 0.02 }\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = -9.81\n[initial]\n"
        "displacement = [{ nodes = \"m\", value = -0.01 }]\nvelocity = [{ nodes = \"m\", value = -2.0 "
        "}]\n[integrator]\n"
        "tolerance = 1e-8\nend_time = 0.01\n",
        {"integrator.type=" + method});
    record::ContactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_NEAR(recorder.impacts().front().peak_force, wanted, 1e-7 * wanted) << method;
  }
}

/// The longest step of this impact lies just below the grid of steps, to which the steps of `rodas4` are rounded.
TEST(HardImpact, ShortensStepsOnTheirGrid) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
      "\"m\"\ngap = 0.1\nsides = \"negative\"\nstiffness = 9216.0001\ndamping = { type = \"kelvin_voigt\", coefficient "
      "= 3.0 }\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = -9.81\n[integrator]\ntype = \"rodas4\"\n"
      "tolerance = 0.1\nend_time = 6.0\n");
  const time::RunReport& report = run.run();
  EXPECT_TRUE(report.completed) << report.message;
}

/// During the rebound the force tends to 0 long before the contact ends, and its sign is rounding.
TEST_P(ImpactMethods, StrongDissipationIsOneImpact) {
  for (int i = 0; i < 8; ++i) {
    const double speed = 1e-3 * std::pow(3.7, i);
    const std::string law =
        "gap = 0.01\nstiffness = 1e6\ndamping = { type = \"hunt_crossley\", restitution = 0.02, "
        "impact_speed = " +
        std::to_string(speed) + " }\n";
    EXPECT_NEAR(bounce(2.0, speed, law, 0.02 / speed + 1.0, GetParam()).restitution, 0.02, 1e-6) << speed;
  }
  for (const double e : {0.02, 0.05}) {
    const std::string dashpot =
        "gap = 0.37\nstiffness = 1e6\ndamping = { type = \"kelvin_voigt\", mass = 2.0, "
        "restitution = " +
        to_text(e);
    for (const std::string end : {" }\n", ", pull = true }\n"})
      EXPECT_NEAR(bounce(2.0, 0.9388293143109239, dashpot + end, 1.0, GetParam()).restitution, e, 1e-6 * e) << e << end;
  }
}

INSTANTIATE_TEST_SUITE_P(Adaptive, ImpactMethods,
                         testing::Values("integrator.type=dopri5", "integrator.type=extrapolation8"));

/// A rotor that whirls steadily on its ring. The rate of penetration stays near 0, and errors of the motion change its
/// sign; they once cut every step.
TEST(ImpactDamping, TakesNoTinyStepsInASteadyWhirl) {
  const std::string toml =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"rotor\"\nmass = 0.125\n[[element]]\ntype = \"spring\"\nnode "
      "= "
      "\"rotor\"\ndof = \"uy\"\nstiffness = 2.3e4\ndamping = 13.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"rotor\"\ndof = \"uz\"\nstiffness = 2.3e4\ndamping = 13.0\n[rotation]\nspeed = 435.0\n[[load]]\ntype = "
      "\"unbalance\"\nnode = \"rotor\"\nmoment = 6.6e-4\n[[contact]]\ntype = \"ring\"\nnodes = \"rotor\"\ngap = "
      "2.3e-3\nstiffness = 1.15e6\nlaw = \"hertz\"\nradius = 0.04\ndamping = { type = \"jankowski\", restitution = "
      "0.74, mass = 0.114 }\nfriction = { coefficient = 0.28, slip_speed = 0.02, smoothing = \"tanh\" "
      "}\n[integrator]\ntype = \"exponential\"\ntolerance = 1e-5\nend_time = 2.0\n";
  for (const auto& [method, most] : {std::pair{"exponential", 2000}, {"dopri5", 20000}, {"extrapolation8", 10000}}) {
    SceneRun run(toml, {std::string("integrator.type=") + method});
    const time::RunReport& report = run.run();
    ASSERT_TRUE(report.completed) << report.message;
    EXPECT_LT(report.steps + report.rejected, most) << method;
  }
}

/// The arctan law also pushes at open stops; that potential belongs to no impact. Reference: DOP853 of scipy at a
/// relative tolerance of 1e-13, with the dissipation of each contact as a further unknown.
TEST(HuntAndCrossley, DissipatesInEveryImpactOnTheArctanLaw) {
  const std::array<double, 3> wanted = {0.0967371, 0.0597471, 0.0395082};
  for (const std::string method : {"extrapolation8", "dopri5", "rodas4", "rk4"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode "
        "= \"m\"\nstiffness = 300.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.01\nsides = "
        "\"positive\"\nlaw = \"arctan\"\nstiffness = 1e5\nregularization = 1e3\ndamping = { type = "
        "\"hunt_crossley\", factor = 0.5 }\n[initial]\nvelocity = [{ nodes = \"m\", value = 0.5 "
        "}]\n[integrator]\nend_time = 1.0\n" +
            std::string(method == "rk4" ? "time_step = 1e-5\n" : "tolerance = 1e-8\n"),
        {"integrator.type=" + method});
    record::ContactRecorder contacts(run.dynamics());
    record::EnergyRecorder energy(run.dynamics(), nullptr, std::nullopt);
    run.simulation().add(contacts);
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << method;
    const std::vector<record::Impact> impacts = contacts.impacts();
    ASSERT_EQ(impacts.size(), 7u) << method;
    double sum = 0.0;
    for (const record::Impact& impact : impacts) sum += impact.dissipated;
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(impacts[i].dissipated, wanted[i], 1e-7) << method << i;
    EXPECT_NEAR(sum, energy.dissipated(), 1e-7) << method;
    EXPECT_NEAR(contacts.wear()[0].dissipated, energy.dissipated(), 1e-7) << method;
  }
}

/// A constant force presses a mass out of a deep start in a stop by Hunt and Crossley, which is released and pressed
/// again. While released it dissipates what it stored. The reference integrates k g d g'^2, or k g |g'| without a
/// force, by rk4 with 2e5 steps.
TEST(HuntAndCrossley, DissipatesWhileItIsReleased) {
  constexpr double kStiffness = 4e5, kFactor = 6.0, kGap = 1e-3, kPush = 100.0, kEnd = 0.02;
  constexpr int kSteps = 200000;
  using Three = std::array<double, 3>;
  const auto derivative = [](const Three& y) {
    const double g = y[0] - kGap, elastic = g > 0.0 ? kStiffness * g : 0.0,
                 force = std::max(0.0, elastic * (1.0 + kFactor * y[1]));
    return Three{y[1], kPush - force, (force - elastic) * y[1]};
  };
  Three y{2e-3, -0.2, 0.0};
  for (int i = 0; i < kSteps; ++i) {
    const double h = kEnd / kSteps;
    const auto at = [&](const Three& slope, double part) {
      return Three{y[0] + part * h * slope[0], y[1] + part * h * slope[1], y[2] + part * h * slope[2]};
    };
    const Three k1 = derivative(y), k2 = derivative(at(k1, 0.5)), k3 = derivative(at(k2, 0.5)),
                k4 = derivative(at(k3, 1.0));
    for (std::size_t j = 0; j < 3; ++j) y[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
  }
  for (const char* method : {"exact", "exponential", "dopri5", "rodas4"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
        "\"m\"\ngap = 1e-3\nsides = \"positive\"\nstiffness = 4e5\ndamping = { type = \"hunt_crossley\", factor = 6.0 "
        "}\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = 100.0\n[initial]\ndisplacement = [{ nodes = \"m\", "
        "value = 2e-3 }]\nvelocity = [{ nodes = \"m\", value = -0.2 }]\n[integrator]\ntolerance = 1e-9\nend_time = "
        "0.02\n",
        {std::string("integrator.type=") + method});
    record::ContactRecorder contacts(run.dynamics());
    record::EnergyRecorder energy(run.dynamics(), nullptr, std::nullopt);
    run.simulation().add(contacts);
    run.simulation().add(energy);
    double before = 0.0;
    run.simulation().start();
    while (run.simulation().advance()) {
      EXPECT_GE(energy.dissipated(), before - 1e-9) << method;
      before = energy.dissipated();
    }
    ASSERT_TRUE(run.simulation().report().completed) << method;
    EXPECT_NEAR(run.simulation().state().x[0], y[0], 1e-8) << method;
    EXPECT_NEAR(energy.dissipated(), y[2], 1e-6) << method;
    EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6) << method;
    EXPECT_NEAR(contacts.wear()[0].dissipated, y[2], 1e-6) << method;
    ASSERT_FALSE(contacts.impacts().empty());
    for (const record::Impact& impact : contacts.impacts()) EXPECT_GT(impact.dissipated, 0.0) << method;
  }
}

/// A light mass on a strong dashpot: the force is largest as the contact closes, c v.
TEST(ImpactDamping, PressesHardestAsTheContactCloses) {
  for (const char* method : {"piecewise", "exact"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1e-5\n[[element]]\ntype = \"spring\"\nnode = "
        "\"m\"\nstiffness = 1e-3\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.05\nsides = "
        "\"positive\"\nstiffness = 1e6\ndamping = { type = \"kelvin_voigt\", coefficient = 30, pull = false "
        "}\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"u\", value = 1.0 }]\n[integrator]\ntype = \"" +
        std::string(method) + "\"\nend_time = 0.3\n");
    record::ContactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    ASSERT_TRUE(run.run().completed) << method;
    const double peak = 30.0 * std::sqrt(0.75);
    EXPECT_NEAR(recorder.impacts().at(0).peak_force, peak, 1e-8 * peak) << method;
    EXPECT_NEAR(recorder.wear()[0].peak_force, peak, 1e-8 * peak) << method;
  }
}

}  // namespace
}  // namespace butee::test::impact_damping_test

// piecewise (closed form) against exact (series, changes located as roots of polynomials), on random chains
// with all kinds of stops, damping and loads that piecewise accepts.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <butee/core/text.hpp>
#include <butee/record/contact_recorder.hpp>
#include <gtest/gtest.h>

#include "models/piecewise_scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::test::piecewise_test {
namespace {

struct Motions {
  std::vector<double> x, v;
};

Motions run(const std::string& scene, const std::string& method, Index dof, const std::string& more = "") {
  constexpr int kSamples = 240;
  SceneRun run(scene + more, {"integrator.type=" + method});
  std::vector<double> times;
  for (int i = 1; i < kSamples; ++i) times.push_back(12.0 * i / kSamples);
  Sampler sampler(dof, times);
  run.simulation().add(sampler);
  const time::RunReport& report = run.run();
  EXPECT_TRUE(report.completed) << method << ": " << report.message << "\n" << scene;
  return {sampler.x, sampler.v};
}

/// Rounding of either method, relative to the peaks; 1.4e-11 was observed.
constexpr double kRounding = 3e-11;
/// Disturbance whose growth is measured, m/s.
constexpr double kDisturbance = 1e-9;

double peak(const std::vector<double>& y) {
  double largest = 0.0;
  for (const double each : y) largest = std::max(largest, std::abs(each));
  return largest;
}

/// Returns the number of compared runs.
unsigned compare(const RandomChain& chain, const std::string& method, const std::string& keys, double tolerance,
                 const std::string& name) {
  const Motions ours = run(chain.scene(), "piecewise", 0), reference = run(chain.scene(), method, 0, keys),
                disturbed = run(chain.scene(kDisturbance), "piecewise", 0);
  const double largest_x = peak(reference.x), largest_v = peak(reference.v);
  double growth = 1.0;
  unsigned compared = 0;
  for (std::size_t i = 0; i < reference.x.size(); ++i) {
    growth = std::max({growth, std::abs(disturbed.x[i] - ours.x[i]) / kDisturbance,
                       std::abs(disturbed.v[i] - ours.v[i]) / kDisturbance});
    if (growth > 1e5) break;  // later differences are amplified rounding
    EXPECT_NEAR(ours.x.at(i), reference.x[i], tolerance * growth * largest_x) << name << " row " << i;
    EXPECT_NEAR(ours.v.at(i), reference.v[i], tolerance * growth * largest_v) << name << " row " << i;
    if (testing::Test::HasFailure()) {
      ADD_FAILURE() << chain.scene();
      break;
    }
    ++compared;
  }
  return compared;
}

TEST(Piecewise, MeetsExactOnRandomChains) {
  constexpr unsigned kChains = 120;
  unsigned compared = 0;
  for (unsigned seed = 0; seed < kChains && !HasFailure(); ++seed)
    compared += compare(RandomChain(seed), "exact", "", kRounding, "seed " + std::to_string(seed));
  EXPECT_GT(compared, kChains * 150);
}

/// With steps as long as the series of `exact` allow, and with shorter ones: both end at changes of contact.
/// A light part on a stiff dashpot between two bodies: slow motion has the rounding of its own rate, not that of the
/// fast decay (up to 1e9 times as fast); and a run that is short beside it that of its own size, under constant and
/// harmonic loads.
TEST(Piecewise, KeepsTheDigitsOfSlowMotionBesideFastDecay) {
  const auto scene = [](const std::string& end, const std::string& damping) {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.4\n[[element]]\ntype = \"mass\"\nname = "
           "\"b\"\nmass = 6e-8\n[[element]]\ntype = \"mass\"\nname = \"c\"\nmass = 2.3\n[[element]]\ntype = "
           "\"spring\"\nnode = \"a\"\nstiffness = 20.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", "
           "\"b\"]\nstiffness = 11.0\ndamping = 1e-3\n[[element]]\ntype = \"spring\"\nnodes = [\"b\", "
           "\"c\"]\nstiffness "
           "= 4e4\ndamping = " +
           damping +
           "\n[[load]]\nnode = \"c\"\ntype = \"harmonic\"\namplitude = 14.0\nangular_frequency = "
           "3.0\nphase = 1.0\n[[load]]\nnode = \"a\"\ntype = \"ramp\"\nto = 2.0\nstart = 0.0\nend = 1.0\n[integrator]\n"
           "end_time = " +
           end + "\n";
  };
  for (const auto& [end, damping] : {std::pair{1e-5, "5"}, std::pair{1e-3, "5"}, std::pair{1e-4, "200"}}) {
    std::vector<double> times;
    for (int i = 1; i <= 20; ++i) times.push_back(end * i / 20);
    std::vector<Motions> ours, reference;
    double largest_x = 0.0, largest_v = 0.0;
    for (const Index dof : {0, 1, 2}) {
      const auto sampled = [&, end = end, damping = damping](const std::string& method) {
        SceneRun run(scene(to_text(end), damping), {"integrator.type=" + method});
        Sampler sampler(dof, times);
        run.simulation().add(sampler);
        EXPECT_TRUE(run.run().completed) << method;
        return Motions{sampler.x, sampler.v};
      };
      ours.push_back(sampled("piecewise"));
      reference.push_back(sampled("exact"));
      largest_x = std::max(largest_x, peak(reference.back().x));
      largest_v = std::max(largest_v, peak(reference.back().v));
    }
    for (std::size_t dof = 0; dof < ours.size(); ++dof)
      for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_NEAR(ours[dof].x.at(i), reference[dof].x.at(i), kRounding * largest_x) << dof << " " << times[i];
        EXPECT_NEAR(ours[dof].v.at(i), reference[dof].v.at(i), kRounding * largest_v) << dof << " " << times[i];
      }
  }
}

TEST(Piecewise, MeetsExactWhereStopsDissipate) {
  constexpr unsigned kChains = 60;
  for (const char* steps : {"", "time_step = 0.01\n"}) {
    unsigned compared = 0;
    for (unsigned seed = 0; seed < kChains && !HasFailure(); ++seed)
      compared += compare(RandomChain(seed, true), "exact", steps, kRounding, "seed " + std::to_string(seed));
    EXPECT_GT(compared, kChains * 150);
  }
}

TEST(Piecewise, FindsTheInstantsOfContact) {
  // exact has an uncertainty of 1e-10 s at the end, because the motion has amplified rounding.
  constexpr double kInstants = 1e-9;
  std::vector<record::Impact> all[2];
  for (const std::string method : {"piecewise", "exact"}) {
    SceneRun run(one_mass(0.0), {"integrator.type=" + method, "integrator.end_time=4.0"});
    record::ImpactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    ASSERT_TRUE(run.run().completed);
    all[method == "exact" ? 1 : 0] = recorder.impacts();
  }
  ASSERT_EQ(all[0].size(), 148U);
  ASSERT_EQ(all[1].size(), 148U);
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    EXPECT_NEAR(all[0][i].t_in, all[1][i].t_in, kInstants);
    EXPECT_NEAR(*all[0][i].t_out, *all[1][i].t_out, kInstants);
    EXPECT_NEAR(all[0][i].peak_force / all[1][i].peak_force, 1.0, 1e-6);
  }
}

/// The force jumps where a stop with a dashpot closes or opens, so that a body that rounding puts back for an instant
/// would be listed as an impact of its own.
TEST(Piecewise, ListsEveryImpactOnDashpotsOnce) {
  for (const char* restitution : {"0.35", "0.2", "0.15"}) {
    for (const char* pull : {"true", "false"}) {
      const std::string scene = R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.01
sides = "positive"
law = "linear"
stiffness = 5e4
damping = { type = "kelvin_voigt", mass = 2.0, restitution = )" +
                                std::string(restitution) + ", pull = " + pull + R"( }
[initial]
velocity = [{ nodes = "m", dof = "u", value = 1.5 }]
[integrator]
type = "piecewise"
end_time = 0.1
)";
      SceneRun run(scene, {});
      record::ContactRecorder recorder(run.dynamics());
      run.simulation().add(recorder);
      ASSERT_TRUE(run.run().completed);
      const std::vector<record::Impact> impacts = recorder.impacts();
      ASSERT_EQ(impacts.size(), 1U) << restitution << ", pull " << pull;
      EXPECT_NEAR(impacts[0].t_in, 0.01 / 1.5, 1e-15);
      EXPECT_NEAR(impacts[0].impact_speed, 1.5, 1e-12);
      EXPECT_NEAR(impacts[0].impulse, 2.0 * 1.5 * (1.0 + std::stod(restitution)), 1e-9);
      EXPECT_NEAR(recorder.impacts()[0].dissipated, 0.5 * 2.0 * 1.5 * 1.5 * (1.0 - std::pow(std::stod(restitution), 2)),
                  1e-9);
    }
  }
}

/// A stop of 1.3e11 N/m between two bodies of a chain that rests on a soft stop while they meet: the two are pushed
/// apart by 2e9 N, and the slow motions of the chain feel the difference only.
TEST(Piecewise, MeetsExactWhereAHardStopActsWhileASoftOneIsClosed) {
  const std::string scene = R"(schema = 1
[[element]]
type = "mass"
name = "m0"
mass = 1.8
[[element]]
type = "mass"
name = "m1"
mass = 0.67
[[element]]
type = "spring"
nodes = ["m0", "m1"]
stiffness = 24600.0
[[element]]
type = "mass"
name = "m2"
mass = 1.73
[[element]]
type = "spring"
nodes = ["m1", "m2"]
stiffness = 4957.0
[[contact]]
type = "stop"
between = ["m0", "m2"]
gap = 0.0172
stiffness = 1.27e11
law = "linear"
[[contact]]
type = "stop"
nodes = "m1"
gap = 0.0188
stiffness = 2285.0
sides = "negative"
law = "linear"
[initial]
velocity = [{ nodes = "m2", value = -1.637 }]
[integrator]
end_time = 0.14
)";
  const auto end_of = [&](const char* method) {
    SceneRun run(scene, {std::string("integrator.type=") + method});
    EXPECT_TRUE(run.run().completed);
    return run.simulation().state();
  };
  const time::State ours = end_of("piecewise"), reference = end_of("exact");
  for (const auto& [y, other] : {std::pair{ours.x, reference.x}, std::pair{ours.v, reference.v}})
    EXPECT_LT((y - other).lpNorm<Eigen::Infinity>() / other.lpNorm<Eigen::Infinity>(), kRounding);
}

/// A moment in the middle of a symmetric beam moves a stop there by rounding only, which is that of the static
/// rotation. (The stop opened and closed at one instant without end.)
TEST(Piecewise, GoesOnWhereOnlyRoundingMovesAStop) {
  SceneRun run(R"(
schema = 1
[material.m]
young_modulus = 6.5e10
density = 5700.0
[section.s]
shape = "circle"
radius = 0.018
[[element]]
type = "beam"
name = "b"
material = "m"
section = "s"
length = 0.97
elements = 2
[[support]]
nodes = ["b:0", "b:2"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "b:1"
gap = 0.0
stiffness = 4.1e7
sides = "negative"
[[load]]
node = "b:1"
dof = "theta"
type = "ramp"
to = 1800.0
start = 0.00204757
end = 0.0020475735
[integrator]
type = "piecewise"
end_time = 0.017
)");
  const time::RunReport& report = run.run();
  EXPECT_TRUE(report.completed) << report.message;
  const time::State& state = run.simulation().state();
  EXPECT_LT(std::abs(state.x[run.dof("b:1")]), 1e-12 * state.x.lpNorm<Eigen::Infinity>());
}

/// Steps of piecewise may span a run at whose ends the body is slow and far from its stop.
TEST(Piecewise, RecordsTheImpactsOfALongStep) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1000.0
damping = 6.0
[[load]]
type = "table"
node = "m"
times = [0.0, 0.05, 0.1]
values = [0.0, 20.0, 0.0]
[[contact]]
type = "stop"
nodes = "m"
gap = 5e-3
law = "linear"
stiffness = 1e6
damping = { type = "kelvin_voigt", coefficient = 200.0 }
[integrator]
end_time = 3.0
)";
  const auto impacts = [&](const std::string& method) {
    SceneRun run(scene, {"integrator.type=" + method});
    record::ContactRecorder recorder(run.dynamics());
    run.simulation().add(recorder);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    return recorder.impacts();
  };
  const std::vector<record::Impact> found = impacts("piecewise"), expected = impacts("exact");
  ASSERT_EQ(expected.size(), 2U);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].t_in, expected[i].t_in, 1e-11);
    EXPECT_NEAR(found[i].t_out.value(), expected[i].t_out.value(), 1e-11);
    EXPECT_NEAR(found[i].peak_force, expected[i].peak_force, 1e-6 * expected[i].peak_force);
    EXPECT_NEAR(found[i].dissipated, expected[i].dissipated, 1e-7 * expected[i].dissipated);
  }
}

}  // namespace
}  // namespace butee::test::piecewise_test

// Loads that change within steps. Peaks and energies where loads or the motion jump: at the end of a base's table, at a
// ramp of a few roundings of t, and where an embedding program sets a force or a motion. References: `exact`, and
// values that follow from the scene.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <butee/core/text.hpp>
#include <butee/embed/structure.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::load_jumps_test {
namespace {

using model::Quantity;

constexpr double kEnd = 3.0;

/// 2 kg on a spring of 800 N/m with a dashpot, over kEnd.
std::string body(const std::string& more) {
  return R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[element]]
type = "spring"
node = "m"
stiffness = 800.0
damping = 1.6
[integrator]
end_time = )" +
         to_text(kEnd) + "\n" + more;
}

/// A base that follows a table, whose acceleration jumps at its end.
std::string base(const std::vector<double>& times, const std::vector<double>& values) {
  const auto list = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : ", ") + to_text(number);
    return "[" + text + "]";
  };
  return "[base]\ndisplacement = { direction = [0, 1, 0], type = \"table\", times = " + list(times) +
         ", values = " + list(values) + " }\n";
}

std::map<std::string, double> peaks(const std::string& scene, const std::string& method, double interval,
                                    const std::vector<Quantity>& quantities) {
  SceneRun run(scene, {"integrator.type=" + method});
  model::OutputRequest request;
  request.interval = interval;
  request.probes = {{"m", run.model().nodes.select("m").nodes.front(), quantities, ""}};
  record::HistoryRecorder history(request, kEnd, run.dynamics(), nullptr);
  run.simulation().add(history);
  EXPECT_TRUE(run.run().completed) << method << ": " << run.simulation().report().message;
  return history.peaks();
}

TEST(PeaksAtTheEndOfATable, AreThoseOfExactInAStepThatEndsThere) {
  const std::string scene = body(base({0.0, 2.0}, {0.0, 0.01}));
  const std::vector<Quantity> quantities = {Quantity::uy, Quantity::uy_v, Quantity::uy_a};
  const auto ours = peaks(scene, "exponential", 1.0, quantities);
  for (const auto& [column, peak] : peaks(scene, "exact", 1.0, quantities))
    EXPECT_NEAR(ours.at(column), peak, 1e-8 * peak) << column;
}

/// A row falls on the end of the table, and the step over the jump is a rounding of t long.
TEST(PeaksAtTheEndOfATable, AreNotDifferencesOfRounding) {
  std::vector<double> times, values;
  for (int i = 0; i <= 30; ++i) {
    times.push_back(0.1 * i - 1.0);
    values.push_back(0.01 * std::sin(7.0 * times.back()));
  }
  const std::string scene = body(base(times, values));
  const std::vector<Quantity> quantities = {Quantity::a_abs, Quantity::v_abs};
  const auto expected = peaks(scene, "exact", 0.01, quantities);
  for (const std::string method : {"extrapolation8", "dopri5", "rodas4"}) {
    const auto ours = peaks(scene, method, 0.01, quantities);
    for (const auto& [column, peak] : expected)
      EXPECT_NEAR(ours.at(column), peak, 1e-3 * peak) << method << " " << column;
  }
}

/// A ramp of 4500 roundings of t: the energies balance to the error of each method.
TEST(EnergyOfSteepRamps, Balances) {
  const std::string scene =
      body("[[load]]\ntype = \"ramp\"\nnode = \"m\"\nto = 50.0\nstart = 1.0\nend = 1.000000000001\n");
  for (const std::string method : {"exponential", "dopri5", "piecewise"}) {
    SceneRun run(scene, {"integrator.type=" + method});
    record::EnergyRecorder energy(run.dynamics(), nullptr, record::OutputTimes(0.05, 0, kEnd));
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << method << ": " << run.simulation().report().message;
    EXPECT_GT(energy.work(), 0.0) << method;
    EXPECT_NEAR(energy.balance_error(), 0.0, 1e-4) << method;
  }
}

/// A force or a motion that an embedding program sets between steps: the state that it makes counts, at once and later;
/// one that is replaced before a step or a question does not.
TEST(PeaksOfJumps, AreThoseThatAProgramSets) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.01\nstiffness = 1e5\nlaw = \"linear\"\n";
  auto structure = embed::Structure::from_toml(
      body(stop), {{"integrator.type=newmark", "integrator.time_step=1e-3"}, {BUTEE_TEST_PLUGINS}, {"m"}});
  structure.follow_peaks("m", {Quantity::u, Quantity::a, Quantity::contact_force});
  structure.advance_to(0.01);
  structure.set_force(0, 1e6);
  structure.set_force(0, 100.0);
  EXPECT_DOUBLE_EQ(structure.peak("m", Quantity::a), 50.0);
  structure.advance_to(0.011);
  EXPECT_DOUBLE_EQ(structure.peak("m", Quantity::a), 50.0);
  structure.set_displacement(0, 0.05);
  structure.advance_to(0.012);
  // The body moves on by 50 m/s^2 times 1e-3 s for less than 1e-3 s.
  EXPECT_GE(structure.peak("m", Quantity::u), 0.05);
  EXPECT_LT(structure.peak("m", Quantity::u), 0.05 + 5e-5);
  EXPECT_GE(structure.peak("m", Quantity::contact_force), 1e5 * (0.05 - 0.01));
  EXPECT_LT(structure.peak("m", Quantity::contact_force), 1e5 * (0.05 + 5e-5 - 0.01));
}

/// A base of constant acceleration loads a mass, on a spring of 1e-3 N/m, by a parabola in time such that the path is
/// u = 16 A s^2 (1 - s)^2, s = t - 0.15 s, until the stop at 0.75 A closes. The cubic through both ends of a step from
/// s = 0 to 1 does not move at all.
TEST(LoadsWithinLongSteps, ReachStopsByACurveThatTheirEndsDoNotShow) {
  constexpr double kHeight = 0.01, kStiffness = 1e-3, kStart = -0.15;
  constexpr double kAway = kStart * (1.0 - kStart);
  const double u = 16.0 * kHeight * kAway * kAway, v = 32.0 * kHeight * kAway * (1.0 - 2.0 * kStart);
  const double force = 16.0 * kHeight * (2.0 - 12.0 * kStart + 12.0 * kStart * kStart) + kStiffness * u;
  const std::string scene =
      R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "mass"
name = "p"
mass = 1.0
[[support]]
nodes = "p"
fix = ["u"]
[[element]]
type = "spring"
nodes = ["p", "m"]
stiffness = 1e-3
[[contact]]
type = "stop"
nodes = "m"
gap = 0.0075
sides = "positive"
stiffness = 100.0
[[load]]
type = "constant"
node = "m"
value = )" +
      to_text(force) + "\n[[base]]\nnodes = [\"p\"]\ninitial_velocity = " +
      to_text(16.0 * kHeight * (24.0 * kStart - 12.0) / kStiffness) +
      "\nacceleration = { direction = [0, 1, 0], type = \"constant\", value = " +
      to_text(16.0 * kHeight * 24.0 / kStiffness) +
      " }\n[initial]\ndisplacement = [{ nodes = \"m\", value = " + to_text(u) +
      " }]\nvelocity = [{ nodes = \"m\", value = " + to_text(v) + " }]\n[integrator]\nend_time = 1.2\n";
  const auto end_of = [&](const std::string& method) {
    SceneRun run(scene + method);
    EXPECT_TRUE(run.run().completed) << method;
    const time::State& state = run.simulation().state();
    return Eigen::Vector2d(state.x[0], state.v[0]);
  };
  const Eigen::Vector2d reference = end_of("type = \"exact\"\n");
  for (const std::string tolerance : {"1e-2", "1e-4", "1e-6"}) {
    const Eigen::Vector2d end = end_of("type = \"exponential\"\ntolerance = " + tolerance + "\n");
    EXPECT_NEAR(end[0], reference[0], 10.0 * std::stod(tolerance) * u) << tolerance;
    EXPECT_NEAR(end[1], reference[1], 10.0 * std::stod(tolerance) * std::abs(v)) << tolerance;
  }
}

}  // namespace
}  // namespace butee::test::load_jumps_test

// The method `exact` against a solution in 80-bit arithmetic that shares no code with it
// (tests/benchmark/plain/reference.cpp), and against itself with other settings if no such solution is
// stored.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::exact_test {
namespace {

/// The motion of one node at given times.
struct Motion {
  std::vector<double> u, v;
};

Motion run_exact(const std::string& toml, const std::string& node, double end_time, const std::vector<double>& times,
                 std::vector<std::string> overrides = {}) {
  overrides.push_back("integrator.type=exact");
  overrides.push_back("integrator.end_time=" + std::to_string(end_time));
  SceneRun scene(toml, overrides);
  Sampler sampler(scene.dof(node), times);
  scene.simulation().add(sampler);
  const time::RunReport& report = scene.run();
  EXPECT_TRUE(report.completed) << report.message;
  return {sampler.x, sampler.v};
}

/// max |a - b| over max |b|
double relative_maximum(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    difference = std::max(difference, std::abs(a.at(i) - b[i]));
    peak = std::max(peak, std::abs(b[i]));
  }
  return difference / peak;
}

struct Case {
  std::string scene, node;
  double end_time;
  double tolerance;  ///< fraction of the peak
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scene << " to " << c.end_time;
}

// Rounding over some thousand series; 1e-12 to 1e-13 was observed.
constexpr double kExact = 1e-11;
// beam4 amplifies rounding by e^(20 t), to 1e-8 at half a second in the worst case; 1e-10 was observed.
constexpr double kChaotic = 1e-8;

class ExactMethod : public testing::TestWithParam<Case> {};

TEST_P(ExactMethod, MeetsTheSolutionIn80Bits) {
  const Case& c = GetParam();
  const CsvTable table(std::string(BUTEE_TEST_DATA) + "/models/reference/" + c.scene + "-linear.csv");
  std::vector<double> times = table.column("t"), u = table.column("u0"), v = table.column("v0");
  const auto rows =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), c.end_time * (1.0 + 1e-9)) - times.begin());
  times.resize(rows);
  u.resize(rows);
  v.resize(rows);
  const Motion motion = run_exact(with_linear_law(c.scene), c.node, c.end_time, times);
  EXPECT_LT(relative_maximum(motion.u, u), c.tolerance);
  EXPECT_LT(relative_maximum(motion.v, v), 10.0 * c.tolerance);  // the velocities of the highest modes jump
}

INSTANTIATE_TEST_SUITE_P(
    OfThePaper, ExactMethod,
    testing::Values(Case{"oscillator", "rotor", 0.2, kExact}, Case{"beam1", "string:middle", 1.0, kExact},
                    Case{"beam2", "string:middle", 1.0, kExact}, Case{"beam3", "string:middle", 1.0, kExact},
                    Case{"beam4", "string:middle", 0.3, kExact}, Case{"beam4", "string:middle", 0.5, kChaotic}),
    [](const auto& one) { return one.param.scene + (one.param.end_time == 0.5 ? "_longer" : ""); });

TEST(ExactMethod, GoesThroughTheBoundaryLayersOfTheArctanLawWhateverItsSettings) {
  // Three hundred passages through layers of 4.5 nm in 0.1 s; the orders 20 and 40 take different steps
  // through all of them.
  std::vector<double> times;
  for (int i = 0; i <= 100; ++i) times.push_back(1e-3 * i);
  const std::string beam3 = read_file(model_path("beam3"));
  const Motion coarse = run_exact(beam3, "string:middle", 0.1, times, {"integrator.order=20"});
  const Motion fine = run_exact(beam3, "string:middle", 0.1, times, {"integrator.order=40"});
  EXPECT_LT(relative_maximum(coarse.u, fine.u), 1e-9);  // rounding in the layers; 1e-11 and less was observed
}

/// sin(20 t)/20 over 3183 periods: if the rounding of the ends of 8500 equal steps had one sign, they would drift by
/// 4e-12 s.
TEST(ExactMethod, TakesStepsWhoseEndsDoNotDrift) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 800.0\n[initial]\nvelocity = [{ nodes = \"m\", value = 1.0 }]\n[integrator]\ntype = "
      "\"exact\"\nend_time = 1000.0\n");
  ASSERT_TRUE(run.run().completed);
  EXPECT_NEAR(20.0 * run.simulation().state().x[0], std::sin(20.0 * 1000.0), 8e-12);
}

TEST(ExactMethod, EndsASeriesAtEveryKinkOfALoad) {
  // A free mass under a table load: the velocity is the integral of a polygon and the position its integral,
  // in closed form.
  const std::string toml =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
      "[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [0.1, 0.3, 0.4]\nvalues = [0.0, 4.0, -2.0]\n"
      "[integrator]\ntype = \"exact\"\ntime_step = 0.05\nend_time = 0.5\n";
  const Motion motion = run_exact(toml, "m", 0.5, {0.1, 0.3, 0.4, 0.5});
  // a = F/2: 0 to 2 over 0.2 s, 2 to -1 over 0.1 s, then constant -1.
  const double v3 = 0.5 * 0.2 * 2.0, v4 = v3 + 0.1 * 0.5 * (2.0 - 1.0), v5 = v4 - 0.1;
  const double x3 = 2.0 * 0.04 / 6.0, x4 = x3 + v3 * 0.1 + 0.01 * (2.0 / 2.0 - 3.0 / 6.0);
  const double x5 = x4 + v4 * 0.1 - 0.005;
  const std::vector<double> v = {0.0, v3, v4, v5}, x = {0.0, x3, x4, x5};
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(motion.v[i], v[i], 1e-15);
    EXPECT_NEAR(motion.u[i], x[i], 1e-15);
  }
}

TEST(ExactMethod, DecidesStopsThatBeginOnTheirBorder) {
  // Zero gap on both sides: the stop acts as a spring from the start, x = v0/w sin(w t).
  const std::string toml =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
      "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 1.0\n"
      "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.0\nlaw = \"linear\"\nstiffness = 7.0\n"
      "[initial]\nvelocity = [{nodes = \"m\", value = 3.0}]\n"
      "[integrator]\ntype = \"exact\"\ntime_step = 0.05\nend_time = 20.0\n";
  const std::vector<double> times = {0.1, 1.0, 5.0, 10.0, 20.0};
  const Motion motion = run_exact(toml, "m", 20.0, times);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(motion.u[i], 1.5 * std::sin(2.0 * times[i]), 1e-13);
}

}  // namespace
}  // namespace butee::test::exact_test

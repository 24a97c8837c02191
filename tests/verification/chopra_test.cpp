#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::chopra_test {
namespace {

/// One unit in the last printed digit: hand-calculated tables contain rounded intermediate results.
constexpr double kPrinted = 1e-4;

/// An oscillator under a half-sine force, in kip, in and s: m = 0.2533, k = 10, a damping ratio of 5 %, F =
/// 10 sin(pi t/0.6) until 0.6 s, steps of 0.1 s. Source: A. K. Chopra, Dynamics of Structures, examples 5.3
/// (average acceleration) and 5.4 (linear acceleration); the same problem is OpenSees' NewmarkIntegrator
/// example. The values are those of these schemes at this step, recomputed by an independent program. The
/// table contains the load at the ends of the steps, which is all that Newmark evaluates.
std::string scene(double beta, const std::string& method) {
  std::string times, values;
  for (int i = 0; i <= 6; ++i) {
    times += std::to_string(0.1 * i) + ", ";
    values += i == 6 ? "0.0" : std::to_string(10.0 * std::sin(std::numbers::pi * i / 6)) + ", ";
  }
  const std::string newton =
      method == "newmark" ? "residual_tolerance = 1e-12\nincrement_tolerance = 1e-12\nmax_iterations = 20\n" : "";
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"roof\"\nmass = 0.2533\n"
         "[[element]]\ntype = \"spring\"\nnode = \"roof\"\nstiffness = 10.0\n[damping]\nmodal = 0.05\n"
         "[[load]]\ntype = \"table\"\nnode = \"roof\"\ntimes = [" +
         times + "]\nvalues = [" + values + "]\n[integrator]\ntype = \"" + method +
         "\"\ntime_step = 0.1\nend_time = 1.0\nbeta = " + std::to_string(beta) + "\n" + newton;
}

struct Table {
  const char* name;
  double beta;
  std::vector<double> u;  ///< in, at 0.1, 0.2 ... 1.0 s
};

std::ostream& operator<<(std::ostream& stream, const Table& table) {
  return stream << table.name;
}

class Chopra : public testing::TestWithParam<Table> {};

TEST_P(Chopra, DisplacementsAreThoseOfTheSameScheme) {
  std::vector<double> times;
  for (int i = 1; i <= 10; ++i) times.push_back(0.1 * i);
  for (const std::string method : {"newmark", "newmark_modified"}) {
    SceneRun run(scene(GetParam().beta, method));
    Sampler roof(run.dof("roof"), times);
    run.simulation().add(roof);
    ASSERT_TRUE(run.run().completed);
    ASSERT_EQ(roof.x.size(), GetParam().u.size());
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(roof.x[i], GetParam().u[i], kPrinted) << method << " at " << times[i] << " s";
  }
}

// The digits of std::to_string for beta = 1/6 change the displacements by less than 1e-6.
INSTANTIATE_TEST_SUITE_P(
    tables, Chopra,
    testing::Values(Table{"average_acceleration",
                          0.25,
                          {0.0437, 0.2326, 0.6121, 1.0825, 1.4309, 1.4231, 0.9622, 0.1908, -0.6044, -1.1442}},
                    Table{"linear_acceleration",
                          1.0 / 6.0,
                          {0.0300, 0.2193, 0.6166, 1.1130, 1.4782, 1.4625, 0.9514, 0.1273, -0.6954, -1.2208}}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace butee::test::chopra_test

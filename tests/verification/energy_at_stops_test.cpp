// A body that bounces between two stops without damping or load conserves its energy. A method that gains
// energy at every impact gives an unbounded error.
#include <cmath>

#include <butee/record/energy.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::energy_at_stops_test {
namespace {

/// The largest relative change of the energy over some hundred impacts, each lasting a few steps.
double largest_change(const std::string& method, double h, const std::string& law) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 50.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.1\nstiffness = 2e5\n" +
      law + "\n[initial]\nvelocity = [{nodes = \"m\", value = 3.0}]\n[integrator]\ntype = \"" + method +
      "\"\ntime_step = " + std::to_string(h) + "\nend_time = 20.0\n");
  run.simulation().start();
  const auto energy = [&] {
    const record::Energy now = record::energy_of(run.simulation().state(), run.dynamics());
    return now.kinetic + now.strain + now.contact;
  };
  const double first = energy();
  double largest = 0.0;
  while (run.simulation().advance()) largest = std::max(largest, std::abs(energy() - first) / first);
  EXPECT_TRUE(run.simulation().report().completed) << run.simulation().report().message;
  return largest;
}

class DiscreteGradientKeepsEnergy : public testing::TestWithParam<std::string> {};

TEST_P(DiscreteGradientKeepsEnergy, AtAnyStep) {
  // Newton's tolerance of 1e-9 of the forces, accumulated some thousand times.
  constexpr double kNewton = 1e-6;
  for (const double h : {0.01, 0.003, 0.001})
    EXPECT_LT(largest_change("discrete_gradient", h, GetParam()), kNewton) << h;
}

TEST_P(DiscreteGradientKeepsEnergy, WhereTheTrapezoidalRuleDoesNot) {
  EXPECT_GT(largest_change("generalized_alpha\"\nrho_inf = 1.0 #", 0.003, GetParam()), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Laws, DiscreteGradientKeepsEnergy,
                         testing::Values("law = \"linear\"", "law = \"arctan\"\nregularization = 1e4"),
                         [](const auto& one) { return one.index == 0 ? "linear" : "arctan"; });

}  // namespace
}  // namespace butee::test::energy_at_stops_test

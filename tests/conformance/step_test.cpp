#include <cmath>

#include <butee/plugin/catalogue.hpp>
#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test {
namespace {

using time::State;
using time::Step;

/// A short pinned beam that strikes its stops at once.
std::string beam_scene(const MethodCase& method, const std::string& law = "law = \"arctan\"\nregularization = 1e5\n") {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
         "0.02\n"
         "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements = 6\n"
         "[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\n" +
         law +
         "[[load]]\ntype = \"harmonic\"\nnode = \"b:middle\"\namplitude = 500.0\nangular_frequency = 60.0\n"
         "[damping]\nmass_proportional = 0.5\nstiffness_proportional = 1e-5\n"
         "[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n"
         "[integrator]\ntype = \"" +
         method.name + "\"\ntime_step = 1e-5\nend_time = 2e-2\n" + method.keys;
}

/// So many steps, but not past the middle of the run.
void advance(SceneRun& run, int steps) {
  for (int i = 0; i < steps && run.simulation().state().t < 1e-2; ++i) ASSERT_TRUE(run.simulation().advance());
}

class Conformance : public testing::TestWithParam<MethodCase> {};

void expect_same(const State& a, const State& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_TRUE(a.x == b.x);
  EXPECT_TRUE(a.v == b.v);
  EXPECT_TRUE(a.a == b.a);
  EXPECT_TRUE(a.memory == b.memory);
}

TEST_P(Conformance, AStepIsAPureFunctionOfStateAndStep) {
  SceneRun run(beam_scene(GetParam()));
  advance(run, 50);
  const State from = run.simulation().state();
  const double h = 1e-5;
  const Step step{h, from.t + h};
  State first, other, again;
  run.integrator().step(from, step, first);
  for (const double other_h : {2e-5, 7e-6, 1e-7}) run.integrator().step(first, {other_h, first.t + other_h}, other);
  run.integrator().step(from, step, again);
  expect_same(first, again);
}

TEST_P(Conformance, AFreshIntegratorContinuesBitForBit) {
  SceneRun run(beam_scene(GetParam())), fresh(beam_scene(GetParam()));
  advance(run, 200);
  const State from = run.simulation().state();
  const Step step{3e-6, from.t + 3e-6};
  State continued, restarted;
  run.integrator().step(from, step, continued);
  fresh.integrator().step(from, step, restarted);
  expect_same(continued, restarted);
}

TEST_P(Conformance, EndsExactlyAtEndTime) {
  SceneRun run(beam_scene(GetParam()));
  const auto& report = run.run();
  EXPECT_TRUE(report.completed) << report.message;
  EXPECT_EQ(report.t_end, 2e-2);
  EXPECT_EQ(run.simulation().state().t, 2e-2);
}

TEST_P(Conformance, AgreesWithAnotherMethodAcrossContact) {
  SceneRun run(beam_scene(GetParam())), other(beam_scene(method_cases().front()));
  ASSERT_TRUE(run.run().completed);
  ASSERT_TRUE(other.run().completed);
  const Index middle = run.dof("b:middle");
  // The adaptive methods' own tolerances, and the first order of modified Newmark across contact, allow no more.
  constexpr double kTolerance = 2e-3;
  const double peak = other.simulation().state().x.lpNorm<Eigen::Infinity>();
  EXPECT_NEAR(run.simulation().state().x[middle], other.simulation().state().x[middle], kTolerance * peak);
}

TEST_P(Conformance, InterpolatesItsOwnEnds) {
  SceneRun run(beam_scene(GetParam()));
  advance(run, 20);
  const State from = run.simulation().state();
  State to;
  ASSERT_EQ(run.integrator().step(from, {1e-5, from.t + 1e-5}, to).status, time::StepStatus::ok);
  const Index dof = run.dof("b:middle");
  for (const State* end : {&from, static_cast<const State*>(&to)}) {
    double x = 0.0, v = 0.0, a = 0.0;
    run.integrator().interpolate(from, to, end->t, {&dof, 1}, {{&x, 1}, {&v, 1}, {&a, 1}});
    // The ends are met up to the rounding of the interpolation weights.
    EXPECT_NEAR(x, end->x[dof], 1e-14 * std::abs(end->x[dof]));
    EXPECT_NEAR(v, end->v[dof], 1e-13 * std::abs(end->v[dof]));
    EXPECT_NEAR(a, end->a[dof], 1e-13 * std::abs(end->a[dof]));
  }
}

TEST_P(Conformance, StopsWithADiagnosisWhereALoadOverflows) {
  std::string scene = beam_scene(GetParam(), "law = \"linear\"\n");
  scene += "\n[[load]]\ntype = \"table\"\nnode = \"b:2\"\ntimes = [0.0, 1e-3, 1.001e-3]\nvalues = [0.0, 0.0, 1e308]\n";
  SceneRun run(scene);
  const auto& report = run.run();
  EXPECT_FALSE(report.completed);
  EXPECT_NE(report.message.find("t = "), std::string::npos) << report.message;
  EXPECT_TRUE(run.simulation().state().x.allFinite());
  EXPECT_GT(report.steps, 0);
  EXPECT_LT(report.t_end, 2e-2);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Conformance, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

TEST(ConformanceSuite, CoversTheWholeCatalogue) {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  std::vector<std::string> registered, covered;
  // SUNDIALS keeps a history of its own, so that its steps are no pure functions: tests/plugins/sundials_test.cpp.
  for (const auto& entry : catalogue.integrators())
    if (entry.module.find("sundials") == std::string::npos) registered.push_back(entry.declaration.name);
  for (const MethodCase& method : method_cases()) covered.push_back(method.name);
  std::sort(registered.begin(), registered.end());
  std::sort(covered.begin(), covered.end());
  EXPECT_EQ(registered, covered);
}

}  // namespace
}  // namespace butee::test

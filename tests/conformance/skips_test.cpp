// Unused features cost no evaluations.
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test::skips_test {
namespace {

constexpr int kSteps = 50;

/// A pinned bar driven by a force.
std::string bar(const MethodCase& method, const std::string& more) {
  return "schema = 1\n[material.steel]\nyoung_modulus = 2e11\ndensity = 8000\n[section.bar]\nshape = "
         "\"general\"\narea = 2e-3\nsecond_moment = 3e-6\n[[element]]\ntype = \"beam\"\nname = \"bar\"\nmaterial = "
         "\"steel\"\nsection = \"bar\"\nlength = 10.0\nelements = 10\n[[support]]\nnodes = [\"bar:first\", "
         "\"bar:last\"]\nfix = [\"u\"]\n[[load]]\ntype = \"harmonic\"\nnode = \"bar:middle\"\namplitude = "
         "300.0\nangular_frequency = 20.0\n" +
         more + "[integrator]\ntype = \"" + method.name +
         "\"\ntime_step = 1e-4\nend_time = " + std::to_string(1e-4 * kSteps) + "\n" + method.keys;
}

std::string stops_at(const std::string& nodes) {
  return "[[contact]]\ntype = \"stop\"\nnodes = " + nodes + "\ngap = 1e-3\nstiffness = 1e6\nlaw = \"linear\"\n";
}

/// The step sizes of a run.
class StepSizes final : public time::Observer {
 public:
  void step(const time::AcceptedStep& step) override { all.insert(step.h); }
  std::set<double> all;
};

class Skips : public testing::TestWithParam<MethodCase> {};

TEST_P(Skips, ContactWhereThereAreNoStops) {
  const MethodCase& method = GetParam();
  SceneRun run(bar(method, ""));
  StepSizes sizes;
  run.simulation().add(sizes);
  ASSERT_TRUE(run.run().completed);
  const linalg::Counters& counters = run.dynamics().counters();
  EXPECT_EQ(counters.contact_evaluations, 0);
  EXPECT_EQ(counters.law_evaluations, 0);
  EXPECT_EQ(counters.factor_updates, 0);
  // M for the first acceleration; for an implicit method also one matrix for each attempted step size.
  const bool is_explicit = !method.is_implicit;
  const auto sizes_tried = static_cast<std::int64_t>(sizes.all.size()) + run.simulation().report().rejected;
  EXPECT_GE(counters.factorizations, is_explicit ? 1 : 2);
  EXPECT_LE(counters.factorizations, is_explicit ? 1 : 1 + sizes_tried);
}

TEST_P(Skips, StopsOnSupports) {
  SceneRun without(bar(GetParam(), "")), with(bar(GetParam(), stops_at(R"(["bar:first", "bar:last"])")));
  ASSERT_TRUE(without.run().completed);
  ASSERT_TRUE(with.run().completed);
  EXPECT_EQ(with.system().skipped_stops, 2);
  EXPECT_EQ(with.dynamics().stop_count(), 0);
  const linalg::Counters &counters = with.dynamics().counters(), &expected = without.dynamics().counters();
  EXPECT_EQ(counters.contact_evaluations, 0);
  EXPECT_EQ(counters.law_evaluations, 0);
  EXPECT_EQ(counters.force_evaluations, expected.force_evaluations);
  EXPECT_EQ(counters.factorizations, expected.factorizations);
  EXPECT_EQ(counters.solves, expected.solves);
  EXPECT_EQ(with.simulation().state().x, without.simulation().state().x);
}

/// Every contact evaluation evaluates one law for each stop that can act.
TEST_P(Skips, TheStopsThatCannotActAmongOthers) {
  SceneRun run(bar(GetParam(), stops_at("\"bar:all\"")));
  ASSERT_TRUE(run.run().completed);
  const linalg::Counters& counters = run.dynamics().counters();
  EXPECT_EQ(run.dynamics().stop_count(), 9);
  EXPECT_GT(counters.contact_evaluations, 0);
  EXPECT_EQ(counters.law_evaluations, 9 * counters.contact_evaluations);
}

TEST_P(Skips, ZeroLoads) {
  const std::string zero =
      "[[load]]\ntype = \"constant\"\nnode = \"bar:2\"\nvalue = 0.0\n[[load]]\ntype = \"distributed\"\nbeam = "
      "\"bar\"\nvalue = 0.0\n";
  SceneRun without(bar(GetParam(), "")), with(bar(GetParam(), zero));
  EXPECT_EQ(with.system().skipped_loads, 2);
  EXPECT_EQ(with.system().loads.size(), 1U);
  ASSERT_TRUE(without.run().completed);
  ASSERT_TRUE(with.run().completed);
  EXPECT_EQ(with.simulation().state().x, without.simulation().state().x);
}

/// A matrix of dashpots is assembled only if a dashpot acts; without any damping the term C v is skipped.
TEST_P(Skips, DampingThatIsNotThere) {
  const std::string spring = "[[element]]\ntype = \"spring\"\nnode = \"bar:3\"\nstiffness = 1e4\ndamping = ";
  SceneRun none(bar(GetParam(), spring + "0.0\n")),
      rayleigh(bar(GetParam(), "[damping]\nmass_proportional = 0.1\nstiffness_proportional = 1e-5\n"));
  EXPECT_FALSE(none.dynamics().has_damping());
  EXPECT_TRUE(rayleigh.dynamics().has_damping());
  EXPECT_EQ(none.system().dashpots.size(), 0);
  EXPECT_EQ(rayleigh.system().dashpots.size(), 0);
  if (!GetParam().takes_dashpots) return;
  SceneRun dashpot(bar(GetParam(), spring + "50.0\n"));
  EXPECT_TRUE(dashpot.dynamics().has_damping());
  EXPECT_GT(dashpot.system().dashpots.size(), 0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Skips, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::skips_test

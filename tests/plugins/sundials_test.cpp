// SUNDIALS through the common interface, if it was found.
#include <butee/plugin/catalogue.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::sundials_test {
namespace {

class Sundials : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    plugin::Catalogue catalogue;
    catalogue.add(BUTEE_TEST_PLUGINS);
    if (catalogue.find(GetParam()) == nullptr) GTEST_SKIP() << "built without SUNDIALS";
  }
};

TEST_P(Sundials, AgreesWithAnotherMethodAcrossContact) {
  const auto end = [](const std::string& method) {
    SceneRun run(with_linear_law("beam1"),
                 {"integrator.type=" + method, "integrator.tolerance=1e-6", "integrator.end_time=0.2"});
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_EQ(run.simulation().state().t, 0.2);
    return run.simulation().state().x;
  };
  const Vector x = end(GetParam()), reference = end("exponential");
  // Its tolerance applies to each component; the run has some thousand steps.
  EXPECT_LT((x - reference).norm(), 1e-3 * reference.norm());
}

/// The overflow occurs in the middle of the run, and in the first step.
TEST_P(Sundials, StopsWithADiagnosisWhereALoadOverflows) {
  for (const char* times : {"[0.0, 0.1, 0.11]", "[0.0, 1e-9, 2e-9]"}) {
    const std::string text =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = "
        "\"spring\"\nnode = \"m\"\nstiffness = 40.0\n[[load]]\ntype = \"table\"\nnode = \"m\"\nvalues = "
        "[1.0, 1.0, 1e308]\ntimes = ";
    SceneRun run(text + times + "\n[integrator]\nend_time = 1.0\ntype = \"" + GetParam() + "\"\n");
    EXPECT_FALSE(run.run().completed) << times;
    EXPECT_TRUE(run.simulation().state().x.allFinite()) << times;
    EXPECT_LT(run.simulation().report().t_end, 1.0) << times;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Sundials, testing::Values("cvode_bdf", "cvode_adams", "arkode_erk", "arkode_dirk"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace butee::test::sundials_test

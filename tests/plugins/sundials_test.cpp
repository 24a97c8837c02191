// SUNDIALS through the common interface, if it was found.
#include <butee/plugin/catalogue.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

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

/// A pipe that turns in rings and rubs, beside a stop in one plane.
TEST_P(Sundials, AgreesWithAnotherMethodInRingsWithFriction) {
  const std::string toml = TurningPipe{"string", "lateral", "35.0", 10, "0.01", "0.01", "3.0"}.scene(
      "[[contact]]\ntype = \"stop\"\nlaw = \"linear\"\nnodes = \"string:middle\"\ndof = \"uy\"\ngap = 0.005\nstiffness "
      "= 1e5\n"
      "[integrator]\ntype = \"exponential\"\nend_time = 0.3\n");
  const auto end = [&toml](const std::string& method, const std::string& tolerance) {
    SceneRun run(toml, {"integrator.type=" + method, "integrator.tolerance=" + tolerance});
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_GT(run.dynamics().counters().law_evaluations, 1000) << method;
    return run.simulation().state().x;
  };
  const Vector x = end(GetParam(), "1e-6"), reference = end("rodas4", "1e-7");
  // Its tolerance applies to each component and step; the run has some thousand steps.
  EXPECT_LT((x - reference).norm(), 1e-3 * reference.norm());
}

TEST_P(Sundials, RefusesOrdersThatTheSolverLacks) {
  const bool has_six = GetParam() == "cvode_adams" || GetParam() == "arkode_erk";
  const std::vector<std::string> six = {"integrator.type=" + GetParam(), "integrator.order=6"};
  if (has_six)
    EXPECT_NO_THROW(SceneRun(mass_on_spring("40.0", ""), six));
  else
    EXPECT_THROW(SceneRun(mass_on_spring("40.0", ""), six), InputError);
}

/// Implicit methods need the slopes of forces.
TEST_P(Sundials, RefusesInfiniteSlopesWhereItTakesSlopes) {
  const std::string toml = mass_on_spring("40.0",
                                          "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.1\nlaw = "
                                          "\"hertz\"\nstiffness = 1e4\ndamping = { type = \"jankowski\", mass = 1.0, "
                                          "restitution = 0.7 }\n");
  const std::vector<std::string> method = {"integrator.type=" + GetParam()};
  if (GetParam() == "arkode_erk") {
    EXPECT_NO_THROW(SceneRun(toml, method));
    return;
  }
  try {
    SceneRun run(toml, method);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is infinite where the contact closes"), std::string::npos);
  }
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

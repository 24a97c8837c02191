#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::faults_test {
namespace {

namespace fs = std::filesystem;

std::string broken(const std::string& name) {
  return std::string(BUTEE_TEST_BROKEN) + "/" + name + ".so";
}

std::string scene_with(const std::string& method) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n"
         "[initial]\ndisplacement = [{nodes = \"a\", value = 1.0}]\n"
         "[integrator]\ntype = \"" +
         method + "\"\ntime_step = 1e-3\nend_time = 1.0\n[output]\ninterval = 1e-3\n";
}

struct Case {
  const char* method;
  const char* says;
};

/// However a method fails after its fifth step, earlier rows are kept and the summary states the failure.
TEST(FaultyModules, AMethodThatBreaksInAStepFailsTheRun) {
  for (const Case& one :
       {Case{"throws_in_step", "the oracle is out"}, Case{"gives_nan", "gives a value that is not a number"},
        Case{"goes_back", "a step ends where it was to end"}, Case{"throws_a_number", "not a std::exception"},
        Case{"loses_a_vector", "a step leaves the sizes"}}) {
    SCOPED_TRACE(one.method);
    const TemporaryFolder folder;
    folder.write("scene.toml", scene_with(one.method));
    const Outcome outcome = run_program({"run", "scene.toml", "--plugin", broken("failing_methods")}, folder.path());
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.errors.find(one.says), std::string::npos) << outcome.errors;
    const auto summary = nlohmann::json::parse(read_file(folder.file("scene-results/summary.json")));
    EXPECT_EQ(summary["status"], "failed");
    EXPECT_NE(std::string(summary["message"]).find(one.says), std::string::npos) << summary["message"];
    EXPECT_EQ(summary["steps"], 5);
    EXPECT_EQ(CsvTable(folder.file("scene-results/history.csv")).rows(), 6U);
  }
}

TEST(FaultyModules, AMethodThatCannotBeMadeLeavesNothing) {
  for (const Case& one :
       {Case{"throws_in_make", "no licence for this scene"}, Case{"makes_nothing", "made no method"}}) {
    SCOPED_TRACE(one.method);
    const TemporaryFolder folder;
    folder.write("scene.toml", scene_with(one.method));
    const Outcome outcome = run_program({"run", "scene.toml", "--plugin", broken("failing_methods")}, folder.path());
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.errors.find(one.says), std::string::npos) << outcome.errors;
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"scene.toml"});
  }
}

/// Without the stop that its law belongs to, the mass would pass it.
TEST(FaultyModules, OneThatMakesNoLawOrWriterFailsTheRun) {
  for (const Case& one : {Case{"no_law", "failing_factories.so: making the law \"no_law\" gave nothing"},
                          Case{"law_with_an_error", "making the law \"law_with_an_error\" failed: no licence"},
                          Case{"law_with_a_number", "failed: it threw an exception that is not a std::exception"}}) {
    SCOPED_TRACE(one.method);
    const TemporaryFolder folder;
    folder.write("scene.toml", scene_with("rk4") + "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 1.5\nlaw = \"" +
                                   one.method + "\"\n");
    const Outcome outcome = run_program({"run", "scene.toml", "--plugin", broken("failing_factories")}, folder.path());
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.errors.find(one.says), std::string::npos) << outcome.errors;
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"scene.toml"});
  }
  const TemporaryFolder folder;
  folder.write("scene.toml", scene_with("rk4") + "formats = [\"no_writer\"]\n");
  const Outcome outcome = run_program({"run", "scene.toml", "--plugin", broken("failing_factories")}, folder.path());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.errors.find("making the format \"no_writer\" gave nothing"), std::string::npos) << outcome.errors;
}

/// A stick spring is stretched along a line or a circle; along a curve of unknown form the force would be wrong.
TEST(Modules, ShapesOfUnknownFormTakeNoStickSprings) {
  const TemporaryFolder folder;
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\ndof = \"uy\"\nstiffness = 400.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\ndof = \"uz\"\nstiffness = "
      "300.0\n[[contact]]\ntype = "
      "\"curved\"\nnodes = \"a\"\ngap = 0.01\nstiffness = 1e4\nfriction = { coefficient = 0.3, ";
  const std::string end = " }\n[integrator]\ntype = \"dopri5\"\nend_time = 0.01\n";
  folder.write("spring.toml", scene + "stick_stiffness = 1e5" + end);
  folder.write("smooth.toml", scene + "slip_speed = 1e-3" + end);
  const Outcome refused = run_program({"run", "spring.toml", "--plugin", broken("failing_factories")}, folder.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("form() is a line or a circle"), std::string::npos) << refused.errors;
  EXPECT_EQ(run_program({"run", "smooth.toml", "--plugin", broken("failing_factories")}, folder.path()).status, 0);
}

/// Such a crash cannot be caught, but the last line of output names the module.
TEST(FaultyModules, OneThatCrashesWhileItIsLoadedIsNamed) {
  for (const char* name : {"static_crash", "static_throw"}) {
    const TemporaryFolder folder;
    const Outcome outcome = run_program({"plugins", "--plugin", broken(name)}, folder.path());
    EXPECT_NE(outcome.status, 0);
    EXPECT_NE(outcome.errors.find(std::string(name) + ".so: crashed the program while it was loaded"),
              std::string::npos)
        << outcome.errors;
  }
}

TEST(FaultyModules, OneThatWasBuiltForAnotherVersionIsRefusedWithTheDifference) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene_with("rk4"));
  const Outcome outcome = run_program({"run", "scene.toml", "--plugin", broken("other_interface")}, folder.path());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.errors.find("built for another butee: interface version"), std::string::npos) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder.file("scene-results")));
}

}  // namespace
}  // namespace butee::test::faults_test

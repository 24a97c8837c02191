#include "support/program.hpp"

#include <cmath>
#include <filesystem>

#include <butee/config/toml.hpp>
#include <butee/core/target.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "unit/scenes.hpp"

namespace butee::test::program_test {
namespace {

using Json = nlohmann::json;

constexpr const char* kScene = R"(schema = 1
title  = "swing"

[[element]]
type = "mass"
name = "ball"
mass = 2.0

[[element]]
type      = "spring"
node      = "ball"
stiffness = 200.0

[[contact]]
type      = "stop"
nodes     = "ball"
gap       = 0.01
stiffness = 1.0e4

[[load]]
type              = "harmonic"
node              = "ball"
amplitude         = 5.0
angular_frequency = 9.0

[integrator]
type      = "rk4"
time_step = 1.0e-3
end_time  = 0.5

[output]
interval = 0.1
impacts  = true
)";

class Program : public testing::Test {
 protected:
  Program() { folder_.write("swing.toml", kScene); }
  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    return run_program(arguments, folder_.path());
  }
  std::string result(const std::string& name) const { return read_file(folder_.file("swing-results/" + name)); }
  Json summary() const { return Json::parse(result("summary.json")); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_.file(name)); }

  TemporaryFolder folder_;
};

TEST_F(Program, RunWritesItsResults) {
  const Outcome outcome = run({"swing.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(holds(outcome.output, "swing-results")) << outcome.output;
  const CsvTable history(folder_.file("swing-results/history.csv"));
  EXPECT_EQ(history.header(), (std::vector<std::string>{"t", "ball.u", "h"}));
  EXPECT_EQ(history.rows(), 6U);
  EXPECT_EQ(history.column("t").back(), 0.5);
  EXPECT_TRUE(exists("swing-results/impacts.csv"));
  const Json json = summary();
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["integrator"], "rk4");
  EXPECT_EQ(json["steps"], 500);
  EXPECT_EQ(json["t_end"], 0.5);
  EXPECT_EQ(json["dofs"], 1);
  EXPECT_EQ(json["contacts"], 1);
  EXPECT_EQ(json["force_evaluations"], 1 + 4 * 500 + 1);  // the last: possible effect of the load, for the growth watch
  EXPECT_GT(json["peak"]["ball.u"], 0.0);
  EXPECT_TRUE(json["energy"]["balance_error"].is_null());
  EXPECT_GT(json["wall_seconds"], 0.0);
  ASSERT_EQ(run({"swing.toml", "--set", "output.energy=true", "--set", "output.checkpoint=50"}).status, 0);
  EXPECT_GT(summary()["wall_seconds"], 0.0);
}

/// On every available instruction set, with active stops.
TEST_F(Program, InstructionSetsDifferInLastDigitsAlone) {
  // 400 steps with a rounding error of about 1e-16 each, through a few impacts
  constexpr double kSame = 1e-10;
  std::vector<double> first;
  for (const std::string& name : targets()) {
    const Outcome outcome = run_program(
        {"run", std::string(BUTEE_TEST_MODELS) + "/beam1.toml", "-o", name, "-q", "--set", "integrator.type=NMM1",
         "--set", "integrator.end_time=0.02", "--set", "integrator.time_step=5e-5", "--set", "contact[0].gap=1e-4"},
        folder_.path(), {std::string("BUTEE_TARGET=").append(name)});
    ASSERT_EQ(outcome.status, 0) << name << outcome.errors;
    const CsvTable history(folder_.file(name + "/history.csv"));
    const std::vector<double> u = history.column(history.header().at(1));
    if (first.empty()) first = u;
    ASSERT_EQ(u.size(), first.size());
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      largest = std::max(largest, std::abs(first[i]));
      difference = std::max(difference, std::abs(u[i] - first[i]));
    }
    EXPECT_GT(largest, 1e-4) << "no stop is hit";
    EXPECT_LE(difference, kSame * largest) << name;
  }
}

TEST_F(Program, AnInstructionSetThatIsNotThereIsBadInput) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"run", "swing.toml"}, {"plugins"}}) {
    const Outcome outcome = run_program(arguments, folder_.path(), {"BUTEE_TARGET=mmx"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.errors, "BUTEE_TARGET=mmx: this processor and this butee have the instruction sets " +
                                  join(targets()) + "; name one of them, or leave the variable unset\n");
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.file("swing-results")));
  const Outcome version = run_program({"--version"}, folder_.path(), {"BUTEE_TARGET=" + targets().back()});
  EXPECT_TRUE(holds(version.output, "instruction set: " + targets().back() + " (available: ")) << version.output;
}

TEST_F(Program, TheModelAsRunIsAModelWithTheSameResults) {
  ASSERT_EQ(run({"swing.toml", "--set", "integrator.type=NMM1", "--set", "contact[0].gap=0.02"}).status, 0);
  const std::string model = result("model.toml"), history = result("history.csv");
  EXPECT_TRUE(holds(model, "gap = 0.02")) << model;
  EXPECT_EQ(summary()["integrator"], "newmark_modified");
  folder_.write("again.toml", model);
  ASSERT_EQ(run({"again.toml", "-o", "swing-results"}).status, 0);
  EXPECT_EQ(result("history.csv"), history);
  EXPECT_EQ(result("model.toml"), model);
}

TEST_F(Program, OverridesChangeTheRun) {
  ASSERT_EQ(run({"swing.toml", "--set", "integrator.time_step=0.01", "--set", "output.impacts=false"}).status, 0);
  EXPECT_EQ(summary()["steps"], 50);
  EXPECT_FALSE(exists("swing-results/impacts.csv"));
}

TEST_F(Program, RepeatLeavesResultsAndCountersOfOneRun) {
  ASSERT_EQ(run({"swing.toml"}).status, 0);
  const std::string history = result("history.csv");
  const Json once = summary();
  ASSERT_EQ(run({"swing.toml", "--repeat", "4"}).status, 0);
  EXPECT_EQ(result("history.csv"), history);
  for (const char* key : {"steps", "force_evaluations", "contact_evaluations", "law_evaluations", "solves"})
    EXPECT_EQ(summary()[key], once[key]) << key;
}

TEST_F(Program, RunningAgainReplacesItsOwnFilesAndKeepsOthers) {
  ASSERT_EQ(run({"swing.toml"}).status, 0);
  folder_.write("swing-results/notes.txt", "mine");
  ASSERT_EQ(run({"swing.toml", "--set", "output.impacts=false"}).status, 0);
  EXPECT_FALSE(exists("swing-results/impacts.csv"));
  EXPECT_EQ(result("notes.txt"), "mine");
  EXPECT_EQ(summary()["status"], "completed");
}

TEST_F(Program, AFolderThatIsNotOursIsLeftAlone) {
  std::filesystem::create_directory(folder_.file("home"));
  folder_.write("home/model.toml", "schema = 1\n");
  const Outcome outcome = run({"swing.toml", "-o", "home"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(holds(outcome.errors, "home")) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(read_file(folder_.file("home/model.toml")), "schema = 1\n");
  EXPECT_FALSE(exists("home/history.csv"));
  EXPECT_FALSE(exists("home/summary.json"));
  EXPECT_EQ(run({"swing.toml", "-o", "swing.toml"}).status, 2);
  EXPECT_EQ(read_file(folder_.file("swing.toml")), kScene);
}

TEST_F(Program, AnEmptyFolderIsTaken) {
  std::filesystem::create_directories(folder_.file("deep/er"));
  EXPECT_EQ(run({"swing.toml", "-o", "deep/er"}).status, 0);
  EXPECT_TRUE(exists("deep/er/history.csv"));
}

TEST_F(Program, BadInputIsStatus2AndWritesNothing) {
  const std::vector<std::vector<std::string>> wrong = {{"absent.toml"},
                                                       {"swing.toml", "--set", "integrator.type=rk5"},
                                                       {"swing.toml", "--set", "contact[7].gap=1"},
                                                       {"swing.toml", "--set", "contact[0].gap=-1"},
                                                       {"swing.toml", "--set", "element[0].mas=1"},
                                                       {"swing.toml", "--repeat", "0"},
                                                       {"swing.toml", "--no-such-option"},
                                                       {}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.errors;
    EXPECT_NE(outcome.errors, "");
  }
  EXPECT_EQ(folder_.entries(), (std::vector<std::string>{"swing.toml"}));
}

/// A step far beyond the stability limit: the run fails, and computed rows are kept as whole lines.
TEST_F(Program, ARunThatFailsIsStatus1AndKeepsItsRows) {
  const Outcome outcome = run({"swing.toml", "--set", "element[1].stiffness=1e12", "--set", "output.interval=1e-3"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(holds(outcome.errors, "grows without a physical cause")) << outcome.errors;
  EXPECT_EQ(summary()["status"], "failed");
  EXPECT_TRUE(holds(summary()["message"], "stability")) << summary()["message"];
  EXPECT_EQ(result("history.csv").back(), '\n');
  EXPECT_GE(CsvTable(folder_.file("swing-results/history.csv")).rows(), 1U);
}

TEST_F(Program, EnergyIsFollowedWhereAskedFor) {
  ASSERT_EQ(run({"swing.toml", "--set", "output.energy=true"}).status, 0);
  const Json energy = summary()["energy"];
  EXPECT_TRUE(energy["work"].is_number());
  EXPECT_EQ(energy["dissipated"], 0.0);
  EXPECT_LT(std::abs(energy["balance_error"].get<double>()), 1e-3);  // the scene's own accuracy at its step
}

}  // namespace
}  // namespace butee::test::program_test

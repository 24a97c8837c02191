#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sys/wait.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::faults_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A second of an oscillator: about 20 kB of history.
constexpr const char* kScene = R"(schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type      = "spring"
node      = "a"
stiffness = 1.0e4
[initial]
displacement = [{nodes = "a", value = 1.0e-2}]
[integrator]
type      = "rk4"
time_step = 1.0e-3
end_time  = 1.0
[output]
interval = 1.0e-3
)";

/// A command line of sh in a folder; $BUTEE is the program.
Outcome shell(const TemporaryFolder& folder, const std::string& command) {
  const TemporaryFolder streams;
  const std::string line = "cd " + folder.path() + " && BUTEE=" + BUTEE_TEST_PROGRAM + " && { " + command + "; } >" +
                           streams.file("out") + " 2>" + streams.file("err") + " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(streams.file("out")), read_file(streams.file("err"))};
}

class Faults : public testing::Test {
 protected:
  Faults() { folder_.write("scene.toml", kScene); }
  std::string result(const std::string& name) const { return read_file(folder_.file("scene-results/" + name)); }

  TemporaryFolder folder_;
};

/// A file size limit simulates a full disk: the write that exceeds it fails partway.
TEST_F(Faults, AFullDiskLeavesWholeLinesAndASummary) {
  const Outcome outcome = shell(folder_, "ulimit -f 16; exec $BUTEE run scene.toml -q");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.errors.find("history.csv: cannot be written: File too large"), std::string::npos) << outcome.errors;
  const std::string history = result("history.csv");
  EXPECT_GT(history.size(), 1000U);
  EXPECT_EQ(history.back(), '\n');
  const CsvTable table(folder_.file("scene-results/history.csv"));
  EXPECT_EQ(table.column("t").size(), table.column("h").size());
  const Json summary = Json::parse(result("summary.json"));
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_NE(std::string(summary["message"]).find("history.csv"), std::string::npos);
}

/// The disk then has space again, and the run resumes.
TEST_F(Faults, ARunThatFilledTheDiskCanGoOn) {
  ASSERT_EQ(shell(folder_, "$BUTEE run scene.toml -q -o whole").status, 0);
  const Outcome full = shell(folder_, "ulimit -f 16; exec $BUTEE run scene.toml -q --set output.checkpoint=100");
  EXPECT_EQ(full.status, 1);
  const Outcome resumed = shell(folder_, "$BUTEE run -q --resume scene-results");
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(result("history.csv"), read_file(folder_.file("whole/history.csv")));
}

TEST_F(Faults, AFolderThatCannotBeMadeIsTold) {
  folder_.write("file", "");
  const Outcome outcome = shell(folder_, "$BUTEE run scene.toml -o file/deeper");
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.errors.find("file/deeper: "), std::string::npos) << outcome.errors;
  const Outcome device = shell(folder_, "$BUTEE run scene.toml -o /proc/butee-results");
  EXPECT_EQ(device.status, 1);
  EXPECT_NE(device.errors.find("/proc/butee-results: cannot be created"), std::string::npos) << device.errors;
}

TEST_F(Faults, AReaderThatGoesAwayEndsTheOutputAndNotTheRun) {
  const Outcome outcome = shell(folder_, "{ $BUTEE run scene.toml 2>&1; echo $? >status; } | :");
  EXPECT_EQ(read_file(folder_.file("status")), "0\n") << outcome.errors;
  EXPECT_EQ(Json::parse(result("summary.json"))["status"], "completed");
  const Outcome listing = shell(folder_, "{ $BUTEE plugins; echo $? >status; } | :");
  EXPECT_EQ(read_file(folder_.file("status")), "0\n");
}

TEST_F(Faults, OutputThatFindsNoRoomIsAFailureOfEveryCommand) {
  // The first message is longer than any buffer of the standard library.
  for (const std::string command :
       {"plugins --json", "plugins", "plugins rk4", "help", "help loads", "help --man", "--help", "--version",
        "check scene.toml", "check scene.toml --json", "modes scene.toml", "modes scene.toml --json",
        "stability rk4 --json", "init", "init beam", "completion bash", "run scene.toml", "new-plugin mine"}) {
    const Outcome outcome = shell(folder_, "exec $BUTEE " + command + " >/dev/full");
    EXPECT_EQ(outcome.status, 1) << command;
    EXPECT_NE(outcome.errors.find("butee: error: standard output: cannot be written: No space left on device\n"),
              std::string::npos)
        << command << ": " << outcome.errors;
  }
  const Outcome closed = shell(folder_, "exec $BUTEE plugins --json >&-");
  EXPECT_EQ(closed.status, 1);
  EXPECT_NE(closed.errors.find("standard output: cannot be written: Bad file descriptor"), std::string::npos)
      << closed.errors;
}

/// Otherwise files that a run opens would get the numbers of closed streams and receive its messages.
TEST_F(Faults, ClosedStandardStreamsSpoilNoResult) {
  ASSERT_EQ(shell(folder_, "$BUTEE run scene.toml -q -o whole").status, 0);
  for (const char* closed : {">&-", "<&- >&-", ">&- 2>&-", "<&- >&- 2>&-", "2>&-"}) {
    const Outcome outcome = shell(folder_, std::string("$BUTEE run scene.toml -v --progress always ") + closed);
    EXPECT_EQ(outcome.status, std::string(closed) == "2>&-" ? 0 : 1) << closed;
    EXPECT_EQ(result("history.csv"), read_file(folder_.file("whole/history.csv"))) << closed;
    EXPECT_EQ(Json::parse(result("summary.json"))["status"], "completed") << closed;
  }
}

std::string beams(int count, const std::string& elements) {
  std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
      "0.02\n[integrator]\ntime_step = 1e-5\nend_time = 1.0\ntype = \"rk4\"\n";
  for (int i = 0; i < count; ++i)
    scene += "[[element]]\ntype = \"beam\"\nname = \"b" + std::to_string(i) +
             "\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 1.0\nelements = " + elements + "\n";
  return scene;
}

/// A scene that cannot fit in memory is refused before allocation, with the required size.
TEST_F(Faults, AnAbsurdSceneIsRefusedWithItsSize) {
  folder_.write("absurd.toml", beams(1, "2000000000"));
  const Outcome absurd = shell(folder_, "$BUTEE run absurd.toml");
  EXPECT_EQ(absurd.status, 2);
  EXPECT_NE(absurd.errors.find("elements = 2000000000"), std::string::npos) << absurd.errors;
  EXPECT_FALSE(fs::exists(folder_.file("absurd-results")));
}

#ifndef __SANITIZE_ADDRESS__  // the sanitizer reserves more address space than any limit allows
TEST_F(Faults, TheLimitIsThatOfTheProcess) {
  folder_.write("large.toml", beams(1, "1000000"));
  const Outcome outcome = shell(folder_, "ulimit -v 1000000; exec $BUTEE run large.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("more than the 1.024 GB"), std::string::npos) << outcome.errors;
}

TEST_F(Faults, ASceneThatDoesNotFitGetsOneMessage) {
  folder_.write("large.toml", beams(10, "1000000"));
  const Outcome outcome = shell(folder_, "ulimit -v 3000000; exec $BUTEE check large.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("degrees of freedom and needs about"), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder_.file("large-results")));
}

TEST_F(Faults, ModesThatNeverFitAreRefused) {
  std::string scene = beams(1, "8000");
  scene.replace(scene.find("\"rk4\""), 5, "\"exponential\"\nmodes = 8000");
  folder_.write("modes.toml", scene);
  const Outcome outcome = shell(folder_, "ulimit -v 4000000; exec $BUTEE run modes.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("lowest modes of"), std::string::npos) << outcome.errors;
}
#endif

}  // namespace
}  // namespace butee::test::faults_test

#include <csignal>
#include <filesystem>
#include <random>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/record/folder_lock.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::two_runs_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using std::chrono::microseconds;

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
time_step = 1.0e-4
end_time  = 1.0
[output]
interval = 1.0e-3
energy   = true
)";

std::vector<std::string> run_to(const std::string& end_time) {
  return {"run", "scene.toml", "-q", "-o", "both", "--set", "integrator.end_time=" + end_time};
}

class TwoRuns : public testing::Test {
 protected:
  TwoRuns() { folder_.write("scene.toml", kScene); }

  /// Checks that all files of the folder belong to the run to `end_time`, from the first to the last row.
  void expect_whole(double end_time) const {
    const Json summary = Json::parse(read_file(folder_.file("both/summary.json")));
    EXPECT_EQ(summary["status"], "completed");
    EXPECT_EQ(summary["t_end"], end_time);
    for (const char* name : {"history.csv", "energy.csv"}) {
      const CsvTable table(folder_.file(std::string("both/") + name));
      ASSERT_EQ(table.rows(), static_cast<std::size_t>(std::lround(end_time * 1e3)) + 1) << name;
      EXPECT_EQ(table.column("t").front(), 0.0);
      EXPECT_EQ(table.column("t").back(), end_time);
    }
    const std::string model = read_file(folder_.file("both/model.toml"));
    EXPECT_NE(model.find(end_time == 1.0 ? "end_time = 1.0" : "end_time = 2.0"), std::string::npos) << model;
    EXPECT_FALSE(fs::exists(folder_.file("both/.butee-lock")));
  }

  TemporaryFolder folder_;
};

TEST_F(TwoRuns, IntoOneFolderLeaveOneWholeResult) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program(run_to("2.0"), folder_.path()).status, 0);
  const auto alone = std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - begin);
  std::mt19937 random(20171);
  // The delay is halved if the runs did not overlap and doubled if they did. It thus stays near the length of
  // a run even if the speed of the machine changes.
  std::int64_t longest_delay = alone.count();
  int refused = 0;
  for (int round = 0; round < 50 && !HasFailure(); ++round) {
    if (round % 2 == 0) fs::remove_all(folder_.file("both"));
    Process first(run_to("2.0"), folder_.path());
    usleep(static_cast<useconds_t>(std::uniform_int_distribution<std::int64_t>(0, longest_delay)(random)));
    Process second(run_to("1.0"), folder_.path());
    const int one = first.wait(), other = second.wait();
    EXPECT_TRUE(one == 0 || one == 2) << one;
    EXPECT_TRUE(other == 0 || other == 2) << other;
    ASSERT_TRUE(one == 0 || other == 0);
    const bool met = one == 2 || other == 2;
    if (met) ++refused;
    longest_delay =
        met ? std::min<std::int64_t>(2 * longest_delay, alone.count()) : std::max<std::int64_t>(longest_delay / 2, 1);
    // Both completed: they ran one after the other, in either order.
    const double t_end = Json::parse(read_file(folder_.file("both/summary.json")))["t_end"];
    expect_whole(one == 2 ? 1.0 : other == 2 ? 2.0 : t_end);
  }
  EXPECT_GE(refused, 5);
}

TEST_F(TwoRuns, TheSecondIsToldWhichProcessIsAtIt) {
  fs::create_directory(folder_.file("both"));
  const record::FolderLock lock(folder_.file("both"));
  EXPECT_THROW(record::FolderLock(folder_.file("both")), InputError);
  const Outcome outcome = run_program(run_to("1.0"), folder_.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.errors, "both: process " + std::to_string(getpid()) +
                                " is writing its results there; wait until it has ended, or choose another folder "
                                "with -o\n");
  EXPECT_FALSE(fs::exists(folder_.file("both/model.toml")));
}

TEST_F(TwoRuns, AKilledOneBlocksNobody) {
  // A longer run would be refused where the disk cannot hold its rows.
  Process first(run_to("1e4"), folder_.path());
  while (!fs::exists(folder_.file("both/history.csv")))
    ASSERT_FALSE(first.ends_within(microseconds(1000))) << "exit code " << first.wait();
  const Outcome refused = run_program(run_to("1.0"), folder_.path());
  EXPECT_EQ(refused.status, 2);
  first.send(SIGKILL);
  first.wait();
  ASSERT_TRUE(fs::exists(folder_.file("both/.butee-lock")));
  EXPECT_EQ(run_program(run_to("1.0"), folder_.path()).status, 0);
  expect_whole(1.0);
}

/// A run that is killed before it has written anything leaves a folder that the next run may use.
TEST_F(TwoRuns, ALockAloneMakesNoFolderForeign) {
  fs::create_directory(folder_.file("both"));
  folder_.write("both/.butee-lock", "1\n");
  EXPECT_EQ(run_program(run_to("1.0"), folder_.path()).status, 0);
  expect_whole(1.0);
}

/// Results of a run, fields or a checkpoint alone included, are not replaced by those of other commands.
TEST_F(TwoRuns, OtherCommandsDoNotReplaceTheResultsOfARun) {
  folder_.write("scene.toml",
                std::string(kScene) + "[[output.probe]]\nlabel = \"a\"\nnode = \"a\"\nquantities = [\"u\"]\n");
  for (const char* kept : {"history.csv", "checkpoint.bin"}) {
    ASSERT_EQ(run_program(run_to("0.01"), folder_.path()).status, 0);
    if (kept != std::string("history.csv"))
      for (const char* name : {"history.csv", "energy.csv", "summary.json"})
        fs::rename(folder_.file(std::string("both/") + name), folder_.file("both/checkpoint.bin"));
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"stability", "rk4"}, {"modes", "scene.toml"}, {"compare", "scene.toml"}}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"-q", "-o", "both"});
      const Outcome outcome = run_program(words, folder_.path());
      EXPECT_EQ(outcome.status, 2) << command.front();
      EXPECT_NE(outcome.errors.find("both: holds the results of a run (" + std::string(kept)), std::string::npos)
          << outcome.errors;
    }
    EXPECT_TRUE(fs::exists(folder_.file(std::string("both/") + kept)));
  }
}

}  // namespace
}  // namespace butee::test::two_runs_test

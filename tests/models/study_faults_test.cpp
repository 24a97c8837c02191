#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/study_rows.hpp"

namespace butee::test::study_faults_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using namespace std::chrono_literals;

constexpr const char* kScene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1.0
damping = 0.1
[[contact]]
type = "stop"
nodes = "m"
gap = 1.0
law = "linear"
stiffness = 8.0
[[load]]
type = "harmonic"
node = "m"
amplitude = 0.3
angular_frequency = 1.0
[integrator]
tolerance = 1e-6
)";

std::string study_of(const std::string& vary, const std::string& settings) {
  return "schema = 1\nscene = \"scene.toml\"\n" + vary + "[study]\n" + settings;
}

std::string sweep_of(int count, int settle, const std::string& more = "") {
  return study_of(
      "[[vary]]\nkey = \"load[0].angular_frequency\"\nfrom = 1.0\nto = 1.4\ncount = " + std::to_string(count) + "\n",
      "settle = " + std::to_string(settle) + "\nperiods = 8\ncollect = [\"section m.u\", \"peak m.u\"]\n" + more);
}

bool has_hdf5() {
  return fs::exists(fs::path(BUTEE_TEST_PLUGINS).parent_path() / "study" / "study_hdf5.so");
}

struct KillCase {
  const char* format;
  const char* more;
};

void PrintTo(const KillCase& c, std::ostream* out) {
  *out << c.format << " " << c.more;
}

class KilledStudy : public testing::TestWithParam<KillCase> {};

/// Killed repeatedly after random times until one completes. BUTEE_KILLS sets the number of kills; the
/// default is small.
TEST_P(KilledStudy, EndsWithTheRowsOfTheUndisturbedOne) {
  const KillCase& c = GetParam();
  if (std::string(c.format) == "hdf5" && !has_hdf5()) GTEST_SKIP() << "built without HDF5";
  const char* asked = std::getenv("BUTEE_KILLS");
  const int wanted = asked != nullptr ? std::atoi(asked) : 3;
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(300, 200, c.more));
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program({"study", "study.toml", "-q", "--format", c.format, "-o", "whole"}, folder.path()).status, 0);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
  const Names expected = rows_without_cost(folder.file("study.toml"), folder.file("whole"), c.format);
  std::mt19937 random(2026);
  std::uniform_int_distribution<std::int64_t> delay(whole.count() / 10, whole.count() * 9 / 10);
  int kills = 0;
  for (int tries = 0;; ++tries) {
    ASSERT_LT(tries, 50 * wanted) << "it never ends";
    Process process({"study", "study.toml", "-q", "--format", c.format, "-o", "broken"}, folder.path());
    if (kills < wanted && !process.ends_within(std::chrono::microseconds(delay(random)))) {
      process.send(SIGKILL);
      process.wait();
      ++kills;
      continue;
    }
    ASSERT_EQ(process.wait(), 0);
    if (kills >= wanted) break;
    fs::remove_all(folder.file("broken"));
  }
  EXPECT_EQ(rows_without_cost(folder.file("study.toml"), folder.file("broken"), c.format), expected);
}

INSTANTIATE_TEST_SUITE_P(, KilledStudy,
                         testing::Values(KillCase{"csv", ""}, KillCase{"csv", "follow = true\n"}, KillCase{"hdf5", ""},
                                         KillCase{"hdf5", "follow = true\n"}));

/// The file of rows in a folder of results, or "".
std::string rows_in(const std::string& folder) {
  std::error_code none_yet;
  for (const auto& entry : fs::directory_iterator(folder, none_yet))
    if (entry.path().filename().string().rfind("rows-", 0) == 0) return entry.path().string();
  return "";
}

/// After a power failure the motion of a sweep may be on disk and its last rows not.
TEST(KilledSweep, ComputesLostRowsAgain) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(40, 24000, "follow = \"up\"\n"));  // far longer than the time between savings
  const Names arguments = {"study", "study.toml", "-q", "--format", "csv", "-o"};
  const auto with = [&](const char* name) {
    Names all = arguments;
    all.emplace_back(name);
    return all;
  };
  ASSERT_EQ(run_program(with("whole"), folder.path()).status, 0);
  const Names expected = rows_without_cost(folder.file("study.toml"), folder.file("whole"), "csv");
  Process process(with("broken"), folder.path());
  const auto sweep_file = [&] {
    std::error_code none_yet;
    for (const auto& entry : fs::directory_iterator(folder.file("broken"), none_yet))
      if (entry.path().filename().string().rfind("sweep-", 0) == 0) return entry.path().string();
    return std::string();
  };
  bool has_ended = false;
  for (int i = 0; i < 6000 && !has_ended && sweep_file().empty(); ++i) has_ended = process.ends_within(10ms);
  ASSERT_FALSE(has_ended) << "before its motion was saved";
  process.send(SIGKILL);
  process.wait();
  const std::string file = rows_in(folder.file("broken")), rows = read_file(file);
  const auto last = rows.rfind('\n', rows.size() - 2);
  ASSERT_NE(last, std::string::npos);
  std::ofstream(file, std::ios::binary) << rows.substr(0, last + 1);
  ASSERT_EQ(run_program(with("broken"), folder.path()).status, 0);
  EXPECT_EQ(rows_without_cost(folder.file("study.toml"), folder.file("broken"), "csv"), expected);
}

/// The file of rows of a study that was killed once others could read rows of it: it holds some rows, not all.
std::string interrupted(const TemporaryFolder& folder, const std::string& format) {
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(2000, 4000));
  Process process({"study", "study.toml", "-q", "--format", format, "-o", "broken"}, folder.path());
  bool has_ended = false;
  for (int i = 0; i < 6000 && !has_ended; ++i) {
    has_ended = process.ends_within(10ms);
    const std::string rows = rows_in(folder.file("broken"));
    if (!rows.empty() && !rows_in_file(folder.file("study.toml"), rows, format).empty()) break;
  }
  EXPECT_FALSE(has_ended) << "before it could be interrupted";
  if (!has_ended) process.send(SIGKILL);
  process.wait();
  const std::string rows = rows_in(folder.file("broken"));
  EXPECT_NE(rows, "") << "no rows within a minute";
  return rows;
}

/// A kill during a write may leave any prefix of it: however the file is cut, rows are whole or absent.
TEST(StudyStore, CutAnywhereItGivesWholeRowsAlone) {
  for (const char* format : {"csv", "hdf5"}) {
    if (std::string(format) == "hdf5" && !has_hdf5()) continue;
    const TemporaryFolder folder;
    const std::string rows = interrupted(folder, format);
    ASSERT_FALSE(rows.empty());
    const Names whole = rows_in_file(folder.file("study.toml"), rows, format);
    ASSERT_GT(whole.size(), 0U) << format;
    const std::string text = read_file(rows);
    std::mt19937 random(7);
    for (int i = 0; i < 40; ++i) {
      // Mostly near the end, where the last write was in progress.
      const std::size_t back = random() % (i % 2 == 0 ? std::min<std::size_t>(text.size(), 3000) : text.size());
      std::ofstream(folder.file("cut"), std::ios::binary) << text.substr(0, text.size() - back);
      const Names left = rows_in_file(folder.file("study.toml"), folder.file("cut"), format);
      ASSERT_LE(left.size(), whole.size());
      for (const std::string& row : left)
        EXPECT_NE(std::find(whole.begin(), whole.end(), row), whole.end()) << format << " " << back;
    }
  }
}

TEST(StudyStore, RefusesAnotherSceneStudyOrFormat) {
  const TemporaryFolder folder;
  ASSERT_FALSE(interrupted(folder, "csv").empty());
  const Names arguments = {"study", "study.toml", "-q", "--format", "csv", "-o", "broken"};
  const auto expect_refusal = [&](const Names& call, const std::string& part) {
    const Outcome outcome = run_program(call, folder.path());
    EXPECT_EQ(outcome.status, 2) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  };
  std::string other = kScene;
  folder.write("scene.toml", other.replace(other.find("0.3"), 3, "0.4"));
  expect_refusal(arguments, "the scene, or a file that it names has changed");
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(2000, 4001));
  expect_refusal(arguments, "the study (what varies, how, and what is collected) has changed");
  folder.write("study.toml", sweep_of(2000, 4000));
  if (has_hdf5()) expect_refusal({"study", "study.toml", "-q", "-o", "broken"}, "--format");
  std::string identity = read_file(folder.file("broken/study.toml"));
  const auto build = identity.find("butee ", identity.find("build"));
  identity.replace(build, 6, "otter ");
  folder.write("broken/study.toml", identity);
  expect_refusal(arguments, "butee itself has changed");
}

TEST(StudyStore, IsWrittenByOneProcessAlone) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(20000, 2000));
  Process process({"study", "study.toml", "-q", "--format", "csv", "-o", "shared"}, folder.path());
  for (int i = 0; i < 6000 && !fs::exists(folder.file("shared/study.toml")); ++i) std::this_thread::sleep_for(10ms);
  ASSERT_TRUE(fs::exists(folder.file("shared/study.toml")));
  const Outcome outcome = run_program({"study", "study.toml", "-q", "--format", "csv", "-o", "shared"}, folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.errors;
  EXPECT_NE(outcome.errors.find("is writing its results there"), std::string::npos) << outcome.errors;
  process.send(SIGINT);
  EXPECT_EQ(process.wait(), 1);
  EXPECT_FALSE(fs::exists(folder.file("shared/.butee-lock")));
}

void expect_bad(const std::string& study, const std::string& part, const Names& more = {}) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", study);
  Names arguments = {"study", "study.toml", "--format", "csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2) << study << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_EQ(folder.entries().size(), 2U) << outcome.errors;
}

constexpr const char* kVary = "[[vary]]\nkey = \"contact[0].gap\"\nvalues = [1.0]\n";
constexpr const char* kCollect = "collect = [\"peak m.u\"]\nperiods = 2\n";

/// As for a run, exit status 1: the input is sound, the results cannot be written.
TEST(BadStudies, AFolderThatCannotBeMadeIsAFailureToWrite) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", study_of(kVary, kCollect));
  const Outcome outcome = run_program({"study", "study.toml", "-o", "/proc/nowhere"}, folder.path());
  EXPECT_EQ(outcome.status, 1) << outcome.errors;
  EXPECT_NE(outcome.errors.find("/proc/nowhere: cannot be created"), std::string::npos) << outcome.errors;
  EXPECT_EQ(folder.entries().size(), 2U);
}

TEST(BadStudies, AreRefusedWithKeyAndRemedy) {
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gab\"\nvalues = [1.0]\n", kCollect), "did you mean \"gap\"");
  expect_bad(study_of("[[vary]]\nkey = \"contact[1].gap\"\nvalues = [1.0]\n", kCollect), "there is no contact[1]");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nvalues = []\n", kCollect), "vary[0].values");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\n", kCollect), "give its values in one way");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nvalues = [1.0]\ncount = 5\n", kCollect),
             "vary[0].count = 5: belongs to from and to");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nfrom = 1.0\nto = 1.0\ncount = 3\n", kCollect),
             "the range is empty");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nfrom = 1.0\nto = 2.0\n", kCollect), "vary[0].count");
  expect_bad(
      study_of("[[vary]]\nkey = \"contact[0].gap\"\nfrom = 0.0\nto = 2.0\ncount = 3\nspacing = \"log\"\n", kCollect),
      "log needs from and to above 0");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nfile = \"none.csv\"\n", kCollect),
             "none.csv: does not exist");
  expect_bad(study_of(std::string(kVary) + kVary, kCollect), "varies twice");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nfrom = 1\nto = 2\ncount = 1000000\n"
                      "[[vary]]\nkey = \"load[0].amplitude\"\nfrom = 1\nto = 2\ncount = 1000000\n",
                      kCollect),
             "the plan has 1e+12 points");
  expect_bad(study_of("[[vary]]\nkey = \"contact[0].gap\"\nfrom = 1\nto = 2\ncount = 1000000000000\n", kCollect),
             "vary[0].count");
  expect_bad(study_of(kVary, "periods = 2\ncollect = [\"peek m.u\"]\n"), "did you mean \"peak\"");
  expect_bad(study_of(kVary, "periods = 2\ncollect = [\"peak n.u\"]\n"),
             ": study.collect: \"peak n.u\": \"n\" is neither the label of a probe");
  expect_bad(study_of(kVary, "collect = [\"section m.u\"]\n"), "study.periods: missing");
  expect_bad(study_of(kVary, std::string(kCollect) + "follow = \"sideways\"\n"), "study.follow");
  expect_bad(study_of(kVary, std::string(kCollect) + "plan = \"sobol\"\n"), "study.count: missing");
  expect_bad(study_of(kVary, std::string(kCollect) + "plan = \"sobol\"\ncount = 4\nfollow = true\n"), "study.follow");
  expect_bad(study_of(kVary, std::string(kCollect) + "settel = 3\n"), "did you mean \"settle\"");
  expect_bad("schema = 1\n[study]\nscenes = [\"scene.toml\"]\n", "butee compare");
  expect_bad("schema = 1\nscene = \"nowhere.toml\"\n[study]\ncollect = [\"impacts\"]\n",
             "scene = \"nowhere.toml\": does not exist; the path is relative to the study");
  expect_bad(study_of("[[vary]]\nkey = \"load[7].amplitude\"\nvalues = [1.0, 2.0]\n", kCollect),
             "study.toml:4: vary[0].key = \"load[7].amplitude\": there is no load[7]");
  expect_bad("schema = 1\nscene = \"study.toml\"\n[study]\ncollect = [\"impacts\"]\n",
             "study.toml:2: scene = \"study.toml\": is a study, not a scene");
  expect_bad(study_of(kVary, kCollect), "--shard 3/2", {"--shard", "3/2"});
  expect_bad(study_of(kVary, kCollect), "--points", {"--points", "-"});
  expect_bad(study_of(kVary, kCollect), "scene.toml: is a file, not a folder", {"-o", "scene.toml"});
  expect_bad(study_of(kVary, kCollect), "there is nothing to merge: nowhere does not exist",
             {"--merge", "-o", "nowhere"});
}

TEST(BadStudies, OfPeriodsThatDoNotFollowFromTheLoads) {
  const TemporaryFolder folder;
  std::string scene = kScene;
  folder.write("scene.toml",
               scene + "[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 0.1\nangular_frequency = 2.5\n");
  folder.write("study.toml", study_of(kVary, kCollect));
  Outcome outcome = run_program({"study", "study.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("several frequencies"), std::string::npos) << outcome.errors;
  outcome = run_program({"compare", "study.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("butee study"), std::string::npos) << outcome.errors;
}

TEST(Study, IsSurveyedByCheck) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", sweep_of(16, 3, "follow = true\n"));
  const Outcome outcome = run_program({"check", "study.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  for (const char* part : {"grid: 16 points, 32 runs in 2 sweeps", "load[0].angular_frequency  1.0 ... 1.4, 16 values",
                           "estimate   about"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
  EXPECT_EQ(run_program({"check", "study.toml", "--json"}, folder.path()).status, 0);
}

}  // namespace
}  // namespace butee::test::study_faults_test

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/study_rows.hpp"

namespace butee::test::study_ways_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

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

constexpr const char* kStudy = R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "load[0].angular_frequency"
from = 1.0
to = 1.4
count = 4000
[study]
settle = 10
periods = 8
collect = ["section m.u", "peak m.u"]
)";

bool has_hdf5() {
  return fs::exists(fs::path(BUTEE_TEST_PLUGINS).parent_path() / "study" / "study_hdf5.so");
}

/// Runs a shell command in a folder, with its output in the file `out` there; returns the exit status.
int shell(const TemporaryFolder& folder, const std::string& line) {
  return WEXITSTATUS(std::system(("cd '" + folder.path() + "' && (" + line + ") > out 2>&1 </dev/null").c_str()));
}

std::string program(const std::string& arguments) {
  return "'" BUTEE_TEST_PROGRAM "' " + arguments;
}

/// A file size limit simulates a full disk: write() fails in the same way, with another errno.
class FullDisk : public testing::TestWithParam<const char*> {};

TEST_P(FullDisk, LosesNothingAndIsGoneOnWith) {
  const std::string format = GetParam();
  if (format == "hdf5" && !has_hdf5()) GTEST_SKIP() << "butee was built without HDF5";
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", kStudy);
  const std::string call = program("study study.toml -q --format " + format);
  ASSERT_EQ(shell(folder, call + " -o whole"), 0);
  // In blocks of 512 bytes: enough for the initial writes, too small for all rows.
  EXPECT_EQ(shell(folder, std::string("ulimit -f ") + (format == "csv" ? "800; " : "2400; ") + call + " -o full"), 1);
  const std::string message = read_file(folder.file("out"));
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  EXPECT_FALSE(fs::exists(folder.file("full/study." + std::string(format == "csv" ? "csv" : "h5"))));
  ASSERT_EQ(shell(folder, program("study study.toml --format " + format + " -o full")), 0);
  EXPECT_NE(read_file(folder.file("out")).find("runs are done already"), std::string::npos);
  EXPECT_EQ(rows_without_cost(folder.file("study.toml"), folder.file("full"), format),
            rows_without_cost(folder.file("study.toml"), folder.file("whole"), format));
}

INSTANTIATE_TEST_SUITE_P(, FullDisk, testing::Values("csv", "hdf5"));

/// A job array may leave more files of rows than a process may open.
TEST(ManyShards, AreMergedWithFewOpenFiles) {
  constexpr int kShards = 30;
  for (const char* format : {"csv", "hdf5"}) {
    if (std::string(format) == "hdf5" && !has_hdf5()) GTEST_SKIP() << "butee was built without HDF5";
    const TemporaryFolder folder;
    folder.write("scene.toml", kScene);
    folder.write("study.toml",
                 "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"contact[0].gap\"\nfrom = 0.5\nto = 1.3\n"
                 "count = 60\n[study]\nperiods = 3\ncollect = [\"peak m.u\"]\n");
    const std::string call = program(std::string("study study.toml -q --format ") + format);
    ASSERT_EQ(shell(folder, call + " -o whole"), 0) << read_file(folder.file("out"));
    for (int i = 1; i <= kShards; ++i)
      ASSERT_EQ(shell(folder, call + " -o parts --shard " + std::to_string(i) + "/" + std::to_string(kShards)), 0);
    ASSERT_EQ(shell(folder, "ulimit -n 24; " + call + " -o parts --merge"), 0) << read_file(folder.file("out"));
    EXPECT_EQ(read_file(folder.file("out")), "");
    EXPECT_EQ(rows_without_cost(folder.file("study.toml"), folder.file("parts"), format),
              rows_without_cost(folder.file("study.toml"), folder.file("whole"), format));
  }
}

/// --fresh removes the study's own shards, not folders of other programs with such names.
TEST(ManyShards, OfAnotherProgramAreNotTouched) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml", kStudy);
  fs::create_directories(folder.file("data/shard-1"));
  folder.write("data/shard-1/train.bin", "precious");
  EXPECT_EQ(shell(folder, program("study study.toml -q --format csv -o data --fresh")), 2);
  EXPECT_NE(read_file(folder.file("out")).find("holds no study of butee (it has shard-1)"), std::string::npos)
      << read_file(folder.file("out"));
  ASSERT_EQ(shell(folder, program("study study.toml -q --format csv -o mine --shard 1/2")), 0);
  fs::copy(folder.file("data/shard-1"), folder.file("mine/shard-1"));
  shell(folder, program("study study.toml -q --format csv -o mine --fresh"));
  EXPECT_FALSE(fs::exists(folder.file("mine/shard-1-of-2")) && fs::exists(folder.file("mine/study.csv")));
  EXPECT_EQ(read_file(folder.file("mine/shard-1/train.bin")), "precious");
}

TEST(StudyRuns, OfCountlessPeriodsAreRefused) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"contact[0].gap\"\nfrom = 0.5\nto = 1.3\n"
               "count = 2\n[study]\nsettle = 1\nperiod = 1e-300\nset = [\"integrator.end_time=10.0\"]\n"
               "collect = [\"frequency m.u\"]\n");
  EXPECT_EQ(shell(folder, program("study study.toml -q --format csv -o rows")), 2);
  const std::string message = read_file(folder.file("out"));
  EXPECT_EQ(message.rfind("study.period: 1e-300 s is too short", 0), 0U) << message;
  EXPECT_FALSE(fs::exists(folder.file("rows")));
}

TEST(StudyPictures, AreDrawnOfAFolderWhoseStudyHasGone) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("gaps.csv", "gap\n0.5\n0.9\n1.3\n");
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"contact[0].gap\"\nfile = \"gaps.csv\"\n"
               "column = \"gap\"\n[study]\nperiods = 3\ncollect = [\"peak m.u\"]\n");
  ASSERT_EQ(shell(folder, program("study study.toml -q --format csv -o rows")), 0) << read_file(folder.file("out"));
  fs::remove(folder.file("study.toml"));
  fs::remove(folder.file("scene.toml"));
  ASSERT_EQ(shell(folder, program("plot rows --format script -o pictures")), 0) << read_file(folder.file("out"));
  EXPECT_EQ(read_file(folder.file("out")), "pictures/response-peak-m.u.gp\n");
  EXPECT_NE(read_file(folder.file("pictures/response-peak-m.u.gp")).find("\n0.9 "), std::string::npos);
  // For a study in progress, the existing rows are drawn.
  const std::string rows = read_file(folder.file("rows/study.csv"));
  folder.write("rows/rows-0-0.csv", rows.substr(0, rows.find('\n', rows.find("\n1,") + 1) + 1));
  fs::remove(folder.file("rows/study.csv"));
  ASSERT_EQ(shell(folder, program("plot rows --format script -o pictures")), 0) << read_file(folder.file("out"));
  const std::string script = read_file(folder.file("pictures/response-peak-m.u.gp"));
  EXPECT_NE(script.find("\n0.9 "), std::string::npos);
  EXPECT_EQ(script.find("\n1.3 "), std::string::npos);
  EXPECT_EQ(shell(folder, program("plot rows --kind phase")), 2);
  EXPECT_NE(read_file(folder.file("out")).find("is a study"), std::string::npos);
}

TEST(StudyTrust, IsTheHorizonOfEachRun) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  const std::string study =
      "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"load[0].amplitude\"\nvalues = [0.01, 0.02]\n"
      "[study]\nsettle = 2\nperiods = 3\ncollect = [\"trust\"]\n";
  folder.write("study.toml", study);
  ASSERT_EQ(shell(folder, program("study study.toml -q --format csv -o rows")), 0) << read_file(folder.file("out"));
  // Stops stay open: the trust horizon of a linear oscillator is the end time.
  const CsvTable table(folder.file("rows/study.csv"));
  for (const double horizon : table.column("trust")) EXPECT_NEAR(horizon, 10.0 * std::numbers::pi, 1e-9);
  folder.write("study.toml", study + "follow = true\n");
  EXPECT_EQ(shell(folder, program("study study.toml -q --format csv -o other")), 2);
  EXPECT_NE(read_file(folder.file("out")).find("remove follow"), std::string::npos);
}

/// A parameter file in Dakota 6's standard format, and the results that Dakota reads.
std::string parameters_of(const std::string& load, const std::string& gap) {
  return "                                          2 variables\n                      " + load +
         " v1\n                      " + gap +
         " v2\n                                          1 functions\n"
         "                                          1 ASV_1:peak\n"
         "                                          2 derivative_variables\n"
         "                                          1 DVV_1:v1\n                                          2 DVV_2:v2\n"
         "                                          0 analysis_components\n"
         "                                          1 eval_id\n";
}

TEST(DakotaDriver, AnswersWhatTheStudyGives) {
  const TemporaryFolder folder;
  const std::string drivers = BUTEE_TEST_SOURCE "/apps/studies/drivers";
  folder.write("points.csv", "load[0].amplitude,contact[0].gap\n8.5e3,1e-3\n2e3,5e-4\n");
  ASSERT_EQ(shell(folder, program("study " + drivers + "/sample.toml -q --points points.csv --results rows.csv")), 0)
      << read_file(folder.file("out"));
  const auto peaks = CsvTable(folder.file("rows.csv")).text_column("peak rotor.u");
  const auto answer = [&](const std::string& load, const std::string& gap) {
    folder.write("params.in.1", parameters_of(load, gap));
    const std::string line = "cd '" + drivers + "' && BUTEE='" BUTEE_TEST_PROGRAM "' ./dakota-driver '" +
                             folder.file("params.in.1") + "' '" + folder.file("results.out.1") + "'";
    EXPECT_EQ(shell(folder, line), 0) << read_file(folder.file("out"));
    return read_file(folder.file("results.out.1"));
  };
  EXPECT_EQ(answer("8.500000000000000e+03", "1.000000000000000e-03"), peaks[0] + " response\n");
  EXPECT_EQ(answer("2.000000000000000e+03", "5.000000000000000e-04"), peaks[1] + " response\n");
  EXPECT_EQ(answer("2.000000000000000e+03", "-5.000000000000000e-04"), "FAIL\n");
}

}  // namespace
}  // namespace butee::test::study_ways_test

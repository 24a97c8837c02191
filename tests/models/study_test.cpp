#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/study_rows.hpp"

namespace butee::test::study_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

/// x'' + 0.1 x' + x = 0.3 cos(W t) with one stop of stiffness 8 at x = 1.
constexpr const char* kScene = R"(
schema = 1
title = "One stop"
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
sides = "positive"
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

/// Sixteen short runs.
constexpr const char* kStudy = R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "load[0].amplitude"
from = 0.1
to = 1.6
count = 8
[[vary]]
key = "contact[0].gap"
values = [0.5, 1.0]
[study]
settle = 3
periods = 4
collect = ["section m.u", "peak m.u", "rms m.v", "impacts", "lyapunov"]
)";

bool has_hdf5() {
  return fs::exists(fs::path(BUTEE_TEST_PLUGINS).parent_path() / "study" / "study_hdf5.so");
}

void expect_done(const Names& arguments, const TemporaryFolder& folder, const Names& environment = {}) {
  const Outcome outcome = run_program(arguments, folder.path(), environment);
  ASSERT_EQ(outcome.status, 0) << testing::PrintToString(arguments) << outcome.errors;
}

class StudyProgram : public testing::Test {
 protected:
  StudyProgram() {
    folder_.write("scene.toml", kScene);
    folder_.write("study.toml", kStudy);
  }
  Names rows(const std::string& folder, const std::string& format = "csv") const {
    return rows_without_cost(folder_.file("study.toml"), folder_.file(folder), format);
  }
  void perform(const std::string& to, const Names& more) const {
    Names arguments = {"study", "study.toml", "-q", "-o", to};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_done(arguments, folder_);
  }

  TemporaryFolder folder_;
};

/// In the upward sweep the motion with impacts continues to the fold at W = 1.303214505. In the downward
/// sweep the motion without impacts jumps where it reaches the stop, at W = 1.1304366.
TEST_F(StudyProgram, SweepsJumpWhereTheFoldsAre) {
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "load[0].angular_frequency"
from = 1.11
to = 1.32
count = 211
[study]
follow = true
settle = 300
periods = 4
collect = ["max m.u"]
)");
  perform("sweep", {"--format", "csv"});
  const CsvTable table(folder_.file("sweep/study.csv"));
  const auto w = table.column("load[0].angular_frequency"), x = table.column("max m.u"),
             direction = table.column("direction");
  ASSERT_EQ(w.size(), 422U);
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double fold = direction[i] > 0.0 ? 1.303214505 : 1.1304366;
    const double linear = 0.3 / std::hypot(1.0 - w[i] * w[i], 0.1 * w[i]);
    if (w[i] < fold)
      EXPECT_GT(x[i], 1.3) << w[i] << " " << direction[i];
    else
      EXPECT_NEAR(x[i], linear, 1e-3 * linear) << w[i] << " " << direction[i];
  }
}

TEST_F(StudyProgram, GivesTheSameRowsByThreadsShardsAndFormats) {
  perform("one", {"--format", "csv", "--threads", "1"});
  const Names one = rows("one");
  ASSERT_EQ(one.size(), 16U);
  perform("many", {"--format", "csv", "--threads", "5"});
  EXPECT_EQ(rows("many"), one);
  for (const char* shard : {"1/3", "2/3", "3/3"}) perform("parts", {"--format", "csv", "--shard", shard});
  perform("parts", {"--format", "csv", "--merge"});
  EXPECT_EQ(rows("parts"), one);
  EXPECT_EQ(folder_.entries().size(), 5U);
  EXPECT_FALSE(fs::exists(folder_.file("parts/shard-1-of-3")));
  if (!has_hdf5()) GTEST_SKIP() << "butee was built without HDF5";
  perform("hdf5", {"--threads", "2"});
  EXPECT_EQ(rows("hdf5", "hdf5"), one);
}

TEST_F(StudyProgram, GivesTheSameRowsUnderMpirun) {
  if (!fs::exists(fs::path(BUTEE_TEST_PLUGINS).parent_path() / "study" / "study_mpi.so") ||
      std::system("command -v mpirun >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "built without MPI";
  perform("one", {"--format", "csv"});
  // The address sanitizer's leak check is off because Open MPI itself leaks.
  const std::string command = "cd '" + folder_.path() +
                              "' && ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 "
                              "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
                              "OMPI_MCA_btl=self,vader timeout 100 mpirun -n 2 '" BUTEE_TEST_PROGRAM
                              "' study study.toml --format csv -q -o team > mpi.out 2>&1 </dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_file(folder_.file("mpi.out"));
  EXPECT_EQ(rows("team"), rows("one"));
  // A mistake ends all processes, with one exit status and one message.
  folder_.write("scene.toml", "schema = 1\n");
  const std::string bad = command.substr(0, command.find("-o team")) + "-o other > mpi.out 2>&1 </dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(bad.c_str())), 2) << read_file(folder_.file("mpi.out"));
  EXPECT_FALSE(fs::exists(folder_.file("other")));
}

TEST_F(StudyProgram, AnswersPointsInTheirOrder) {
  perform("one", {"--format", "csv"});
  const CsvTable all(folder_.file("one/study.csv"));
  const auto peaks = all.text_column("peak m.u"), amplitudes = all.text_column("load[0].amplitude");
  std::string points = "contact[0].gap,load[0].amplitude\n# a comment\n";
  for (std::size_t i = all.rows(); i-- > 0;) points += (i % 2 == 0 ? "0.5," : "1.0,") + amplitudes[i] + "\n";
  folder_.write("points.csv", points + "0.5\n-1.0,0.3\n");
  const Outcome outcome =
      run_program({"study", "study.toml", "--points", "points.csv", "--results", "-", "-q", "-j", "3"}, folder_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  folder_.write("answers.csv", outcome.output);
  const CsvTable answers(folder_.file("answers.csv"));
  ASSERT_EQ(answers.rows(), all.rows() + 2);
  const auto found = answers.text_column("peak m.u"), status = answers.text_column("status");
  for (std::size_t i = 0; i < all.rows(); ++i) EXPECT_EQ(found[i], peaks[all.rows() - 1 - i]) << i;
  EXPECT_EQ(status[all.rows()], "refused");
  EXPECT_EQ(status[all.rows() + 1], "refused");
}

/// Forces of elements are sampled; the interval of the scene makes the samples as dense as the rows of a run. At
/// resonance the displacement reaches 0.3/0.1 and the force of spring and dashpot sqrt(1.01) times that.
TEST_F(StudyProgram, SamplesForcesAtTheIntervalOfTheScene) {
  std::string scene = kScene;
  const std::size_t stop = scene.find("[[contact]]");
  scene.erase(stop, scene.find("[[load]]") - stop);
  folder_.write("scene.toml", scene + "end_time = 400.0\n[output]\ninterval = 2e-3\n");
  folder_.write("study.toml",
                "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"load[0].amplitude\"\nvalues = [0.3]\n[study]\n"
                "collect = [\"peak m.spring_force\"]\n");
  perform("rows", {"--format", "csv"});
  const CsvTable rows(folder_.file("rows/study.csv"));
  ASSERT_EQ(rows.rows(), 1U);
  EXPECT_NEAR(std::stod(rows.text_column("peak m.spring_force")[0]), 3.0 * std::sqrt(1.01), 5e-7);
}

/// More points than are read ahead; a signal ends the study however many threads wait for them.
TEST_F(StudyProgram, ASignalEndsTheAnswersToPoints) {
  std::string points = "contact[0].gap,load[0].amplitude\n";
  for (int i = 0; i < 2000; ++i) points += "0.5,0.3\n";
  folder_.write("points.csv", points);
  for (const std::string threads : {"1", "2"}) {
    fs::remove(folder_.file("rows.csv"));
    Process process({"study", "study.toml", "--set", "integrator.tolerance=1e-9", "--points", "points.csv", "--results",
                     "rows.csv", "-q", "-j", threads},
                    folder_.path());
    while ((!fs::exists(folder_.file("rows.csv")) || fs::file_size(folder_.file("rows.csv")) < 300) &&
           !process.ends_within(std::chrono::milliseconds(1)))
      continue;
    process.send(SIGTERM);
    EXPECT_TRUE(process.ends_within(std::chrono::milliseconds(10000))) << threads;
    EXPECT_EQ(process.wait(), 1) << threads;
    EXPECT_EQ(read_file(folder_.file("rows.csv")).back(), '\n');
  }
}

/// Excel begins a file in UTF-8 with a byte-order mark.
TEST_F(StudyProgram, TakesPointsWithAByteOrderMarkAndRefusesAmbiguousOnes) {
  const std::string mark = "\xEF\xBB\xBF", header = "contact[0].gap,load[0].amplitude\n";
  folder_.write("points.csv", mark + header + "0.5,0.3\n");
  const auto answers = [&](const std::string& results) {
    return run_program({"study", "study.toml", "--points", "points.csv", "--results", results, "-q"}, folder_.path());
  };
  Outcome outcome = answers("-");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find(",completed,"), std::string::npos) << outcome.output;
  const std::string before = read_file(folder_.file("points.csv"));
  outcome = answers("points.csv");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("is the file of the points"), std::string::npos) << outcome.errors;
  EXPECT_EQ(read_file(folder_.file("points.csv")), before);
  folder_.write("points.csv", "contact[0].gap,contact[0].gap\n0.5,0.3\n");
  outcome = answers("-");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("names contact[0].gap twice"), std::string::npos) << outcome.errors;
  folder_.write("points.csv", "contact[0].gap;load[0].amplitude\n0,5;0,3\n");
  outcome = answers("-");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("line 1 separates names by semicolons"), std::string::npos) << outcome.errors;
}

TEST_F(StudyProgram, FailedPointsAreRowsWithTheirReason) {
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
values = [1.0, -1.0]
[[vary]]
key = "integrator.type"
values = ["rk4", "newmark"]
[study]
set = ["integrator.tolerance=", "integrator.time_step=2.9"]
settle = 10
periods = 10
collect = ["peak m.u"]
)");
  perform("rows", {"--format", "csv"});
  const std::string text = read_file(folder_.file("rows/study.csv"));
  EXPECT_NE(text.find(",failed,"), std::string::npos) << text;
  EXPECT_NE(text.find("contact[0].gap = -1.0: must be >= 0 (m)"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
}

/// Wherever it is among the points.
TEST_F(StudyProgram, ARefusedPointIsARow) {
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
values = [-1.0, 1.0]
[study]
settle = 10
periods = 10
collect = ["peak m.u"]
)");
  perform("rows", {"--format", "csv"});
  const std::string text = read_file(folder_.file("rows/study.csv"));
  EXPECT_NE(text.find("contact[0].gap = -1.0: must be >= 0 (m)"), std::string::npos) << text;
  EXPECT_NE(text.find(",completed,"), std::string::npos) << text;
  folder_.write("points.csv", "contact[0].gap\n-1.0\n1.0\n");
  const Outcome streamed =
      run_program({"study", "study.toml", "--points", "points.csv", "--results", "-", "-q"}, folder_.path());
  EXPECT_EQ(streamed.status, 0) << streamed.errors;
  EXPECT_NE(streamed.output.find(",refused,"), std::string::npos) << streamed.output;
  EXPECT_NE(streamed.output.find(",completed,"), std::string::npos) << streamed.output;
}

TEST_F(StudyProgram, RandomPlansAndTextsAndFiles) {
  folder_.write("points.csv", "gap,name\n0.5,linear\n1.5,linear\n");
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
file = "points.csv"
column = "gap"
[[vary]]
key = "contact[0].law"
file = "points.csv"
column = "name"
[study]
plan = "list"
periods = 2
collect = ["peak m.u"]
)");
  perform("list", {"--format", "csv"});
  EXPECT_EQ(rows("list").size(), 2U);
  EXPECT_EQ(CsvTable(folder_.file("list/study.csv")).text_column("contact[0].law")[1], "linear");
  for (const char* plan : {"sobol", "latin"}) {
    folder_.write(
        "study.toml",
        std::string("schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"contact[0].gap\"\nfrom = 0.5\nto = 2.0\n"
                    "[[vary]]\nkey = \"load[0].amplitude\"\nfrom = 0.01\nto = 1.0\nspacing = \"log\"\n"
                    "[study]\ncount = 8\nseed = 3\nperiods = 2\ncollect = [\"peak m.u\"]\nplan = \"") +
            plan + "\"\n");
    perform(plan, {"--format", "csv"});
    const auto gaps = CsvTable(folder_.file(std::string(plan) + "/study.csv")).column("contact[0].gap");
    ASSERT_EQ(gaps.size(), 8U);
    for (int part = 0; part < 8; ++part)
      EXPECT_EQ(
          std::count_if(gaps.begin(), gaps.end(), [&](double g) { return std::floor((g - 0.5) / 1.5 * 8.0) == part; }),
          1)
          << part;
  }
}

TEST_F(StudyProgram, IsReadByH5py) {
  if (!has_hdf5()) GTEST_SKIP() << "built without HDF5";
  perform("h5", {});
  perform("csv", {"--format", "csv"});
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (std::system((std::string(python) + " -c 'import h5py' >/dev/null 2>&1").c_str()) != 0) continue;
    const std::string command = std::string(python) + " '" BUTEE_TEST_SOURCE "/tests/models/check_study.py' '" +
                                folder_.file("h5/study.h5") + "' '" + folder_.file("csv/study.csv") + "' > '" +
                                folder_.file("out") + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_file(folder_.file("out"));
    return;
  }
  GTEST_SKIP() << "no Python with h5py";
}

TEST_F(StudyProgram, DrawsWhatItsRowsAllow) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) GTEST_SKIP() << "no gnuplot";
  perform("map", {"--format", "csv", "--plot", "--plot-format", "svg"});
  EXPECT_NE(read_file(folder_.file("map/plots/map-peak-m.u.svg")).find("</svg>"), std::string::npos);
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "load[0].angular_frequency"
from = 1.0
to = 1.4
count = 5
[study]
follow = true
settle = 3
periods = 4
collect = ["section m.u", "section m.v", "peak m.u"]
)");
  perform("sweep", {"--format", "csv", "--plot", "--plot-format", "svg"});
  for (const char* name : {"bifurcation-section-m.u.svg", "response-peak-m.u.svg", "poincare-m.svg"})
    EXPECT_NE(read_file(folder_.file(std::string("sweep/plots/") + name)).find("</svg>"), std::string::npos) << name;
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
values = [0.9, 1.0]
[[vary]]
key = "load[0].angular_frequency"
from = 1.0
to = 1.4
count = 3
[study]
follow = true
settle = 3
periods = 4
collect = ["peak m.u"]
)");
  perform("sweeps", {"--format", "csv", "--plot", "--plot-format", "svg"});
  for (const char* name : {"map-peak-m.u-up.svg", "map-peak-m.u-down.svg"})
    EXPECT_NE(read_file(folder_.file(std::string("sweeps/plots/") + name)).find("</svg>"), std::string::npos) << name;
  folder_.write("study.toml", R"(
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
from = 0.5
to = 1.5
[study]
plan = "latin"
count = 9
periods = 4
collect = ["peak m.u"]
)");
  perform("latin", {"--format", "csv", "--plot", "--plot-format", "svg"});
  EXPECT_NE(read_file(folder_.file("latin/plots/histogram-peak-m.u.svg")).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace butee::test::study_test

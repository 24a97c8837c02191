// The probes in fields.h5, read by h5py, equal the columns of history.csv bit for bit: at the end, during a
// run, after a failure and after a kill.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <regex>

#include <gtest/gtest.h>

#include "plots/field_parts.hpp"
#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::field_probes_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string scene(const std::string& output) {
  return std::string(kParts) + R"([[contact]]
type = "stop"
nodes = "string:all"
gap = 2.0e-3
stiffness = 1.0e6
law = "linear"
[[load]]
type = "harmonic"
node = "string:middle"
amplitude = 2000.0
angular_frequency = 30.0
[integrator]
type = "newmark"
time_step = 1.0e-4
end_time = 0.3
[output]
)" + output +
         R"(
[[output.probe]]
label = "mid"
node = "string:middle"
quantities = ["u", "v", "a", "theta", "contact_force", "M"]
[[output.probe]]
label = "rotor"
node = "rotor"
quantities = ["u"]
)";
}

/// The output of check_probes.py for two files of the folder.
std::string compared(const TemporaryFolder& folder, const std::string& h5, const std::string& csv,
                     const std::string& how) {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (std::system((std::string(python) + " -c 'import h5py' >/dev/null 2>&1").c_str()) != 0) continue;
    const std::string command = std::string(python) + " '" BUTEE_TEST_SOURCE "/tests/plots/check_probes.py' '" +
                                folder.file(h5) + "' '" + folder.file(csv) + "' " + how + " > '" + folder.file("out") +
                                "' 2>&1";
    const bool ok = std::system(command.c_str()) == 0;
    return (ok ? "" : "failed: ") + read_file(folder.file("out"));
  }
  return "no Python with h5py";
}

class ProbesInFields : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(BUTEE_TEST_PLUGINS "/hdf5.so")) GTEST_SKIP() << "built without HDF5";
    if (compared(folder_, "", "", "") == "no Python with h5py") GTEST_SKIP() << "no Python with h5py";
  }
  Outcome run(const std::string& output, std::vector<std::string> more = {}) {
    folder_.write("scene.toml", scene(output));
    std::vector<std::string> arguments = {"run", "scene.toml", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, folder_.path());
  }
  std::string compared_whole() {
    return compared(folder_, "scene-results/fields.h5", "scene-results/history.csv", "whole");
  }

  TemporaryFolder folder_;
};

TEST_F(ProbesInFields, AreTheColumnsOfHistory) {
  // The probes have their own rows, independent of those of the fields.
  ASSERT_EQ(run("interval = 2.0e-4\nformats = [\"csv\", \"hdf5\"]\nfields = {interval = 0.02}").status, 0);
  EXPECT_EQ(compared_whole(), "1501 rows of 9 columns agree\n");
}

TEST_F(ProbesInFields, FollowRowsThatCountSteps) {
  ASSERT_EQ(run("every = 7\nformats = [\"csv\", \"hdf5\"]").status, 0);
  EXPECT_EQ(compared_whole(), "430 rows of 9 columns agree\n");
}

TEST_F(ProbesInFields, AreThereWithoutHistory) {
  ASSERT_EQ(run("interval = 1.0e-3\nformats = [\"csv\"]", {"-o", "plain"}).status, 0);
  ASSERT_EQ(run("interval = 1.0e-3\nformats = [\"hdf5\"]").status, 0);
  EXPECT_FALSE(fs::exists(folder_.file("scene-results/history.csv")));
  EXPECT_EQ(compared(folder_, "scene-results/fields.h5", "plain/history.csv", "whole"),
            "301 rows of 9 columns agree\n");
}

TEST_F(ProbesInFields, OfAFailedRunAreWhole) {
  // rk4 grows without bound at this step.
  const Outcome outcome =
      run("interval = 1.0e-3\nformats = [\"csv\", \"hdf5\"]",
          {"--set", "integrator.type=rk4", "--set", "integrator.time_step=1e-3", "--set", "integrator.end_time=1e3"});
  ASSERT_EQ(outcome.status, 1) << outcome.errors;
  const CsvTable history(folder_.file("scene-results/history.csv"));
  EXPECT_GT(history.rows(), 2U);
  EXPECT_EQ(compared_whole(), std::to_string(history.rows()) + " rows of 9 columns agree\n");
}

TEST_F(ProbesInFields, AreReadUnderWayAndAfterAKill) {
  folder_.write("scene.toml", scene("interval = 1.0e-4\nformats = [\"csv\", \"hdf5\"]"));
  Process process({"run", "scene.toml", "-q", "--set", "integrator.end_time=1e3"}, folder_.path());
  const std::string h5 = "scene-results/fields.h5", csv = "scene-results/history.csv";
  const auto has_rows = [&] {
    return fs::exists(folder_.file(csv)) && fs::file_size(folder_.file(csv)) > 300000 && fs::exists(folder_.file(h5)) &&
           fs::file_size(folder_.file(h5)) > 200000;
  };
  while (!has_rows() && !process.ends_within(1ms)) continue;
  const std::regex agreement("[1-9][0-9]* rows of 9 columns agree\n");
  const std::string under_way = compared(folder_, h5, csv, "growing");
  EXPECT_TRUE(std::regex_match(under_way, agreement)) << under_way;
  ASSERT_FALSE(process.ends_within(1ms));
  process.send(SIGKILL);
  process.wait();
  const std::string killed = compared(folder_, h5, csv, "part");
  EXPECT_TRUE(std::regex_match(killed, agreement)) << killed;
  // The run cannot be resumed, and the attempt loses nothing.
  const std::string before = read_file(folder_.file(h5));
  const Outcome resumed = run_program({"run", "--resume", "scene-results"}, folder_.path());
  EXPECT_EQ(resumed.status, 2);
  EXPECT_NE(resumed.errors.find("the run saved no checkpoints"), std::string::npos) << resumed.errors;
  EXPECT_TRUE(read_file(folder_.file(h5)) == before);
}

}  // namespace
}  // namespace butee::test::field_probes_test

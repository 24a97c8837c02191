#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include <butee/core/text.hpp>
#include <butee/version.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "conformance/methods.hpp"
#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::resume_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A pinned beam that strikes its stops, with every kind of output.
std::string scene_of(const MethodCase& method, double end_time, int checkpoint) {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\n"
         "radius = 0.02\n"
         "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements = 6\n"
         "[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\nlaw = \"linear\"\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b:middle\"\namplitude = 500.0\nangular_frequency = 60.0\n"
         "[damping]\nmass_proportional = 0.5\n"
         "[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n"
         "[integrator]\ntype = \"" +
         method.name + "\"\ntime_step = 1e-5\nend_time = " + to_text(end_time) + "\n" + method.keys +
         "[output]\ninterval = 1e-4\nenergy = true\nimpacts = true\n" +
         (checkpoint > 0 ? "checkpoint = " + std::to_string(checkpoint) + "\n" : "");
}

/// All results in summary.json; times and the cost of repeated set-up are removed.
Json results(const std::string& path) {
  Json json = Json::parse(read_file(path));
  for (const char* key : {"setup_seconds", "wall_seconds", "force_evaluations", "contact_evaluations",
                          "law_evaluations", "factorizations", "factor_updates", "solves"})
    json.erase(key);
  return json;
}

void expect_same_results(const TemporaryFolder& folder, const std::string& a, const std::string& b) {
  for (const char* name : {"/history.csv", "/impacts.csv", "/energy.csv"})
    EXPECT_TRUE(read_file(folder.file(a + name)) == read_file(folder.file(b + name))) << name;
  EXPECT_EQ(results(folder.file(a + "/summary.json")), results(folder.file(b + "/summary.json")));
}

const std::vector<std::string> kResume = {"run", "--resume", "broken", "-q"};

/// Kills a run and each resumed run after random times until one completes; returns the number of kills.
int kill_until_done(const TemporaryFolder& folder, const std::string& checkpoint, std::mt19937& random,
                    std::chrono::microseconds whole) {
  std::uniform_int_distribution<std::int64_t> delay(0, whole.count() * 3 / 4);
  for (int kills = 0;; ++kills) {
    const bool goes_on = fs::exists(folder.file("broken/model.toml"));
    Process process(
        goes_on ? kResume : std::vector<std::string>{"run", "scene.toml", "-o", "broken", "-q", "--set", checkpoint},
        folder.path());
    // Delays increase with the number of kills, so that a run eventually completes.
    if (!process.ends_within(std::chrono::microseconds(delay(random)) * (1 + kills / 10))) {
      process.send(SIGKILL);
      process.wait();
      continue;
    }
    EXPECT_EQ(process.wait(), 0);
    return kills;
  }
}

/// A mass that rubs round its ring, with every kind of output.
std::string ring_scene(const std::string& integrator, const std::string& friction) {
  std::string toml = "schema = 1\n[rotation]\nspeed = 30.0\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n";
  for (const char* dof : {"uy", "uz"})
    toml += "[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"" + std::string(dof) +
            "\"\nstiffness = 2e3\ndamping = 2.0\n";
  return toml +
         "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 1e-3\nstiffness = 1e6\nradius = 0.05\nfriction = { "
         "coefficient = 0.2, " +
         friction +
         " }\n[[load]]\ntype = \"unbalance\"\nnode = \"m\"\nmoment = 5e-3\n[initial]\n"
         "velocity = [{ nodes = \"m\", dof = \"uz\", value = 0.1 }]\n[integrator]\nend_time = 0.5\n" +
         integrator + "[output]\ninterval = 1e-3\nenergy = true\nimpacts = true\n";
}

class Resume : public testing::TestWithParam<MethodCase> {};

/// BUTEE_KILLS sets the number of kills for each method; the default is small.
TEST_P(Resume, AKilledRunEndsLikeTheUnbrokenOne) {
  const char* asked = std::getenv("BUTEE_KILLS");
  const int wanted = asked != nullptr ? std::atoi(asked) : 2;
  const TemporaryFolder folder;
  folder.write("scene.toml", scene_of(GetParam(), 2e-2, 0));
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program({"run", "scene.toml", "-o", "whole", "-q"}, folder.path()).status, 0);
  const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
  // About twenty checkpoints in a run, because each waits for the disk.
  const bool in_blocks = GetParam().name == "exponential" || GetParam().name == "auto";
  const std::int64_t steps = results(folder.file("whole/summary.json"))["steps"];
  const std::string checkpoint = "output.checkpoint=" + std::to_string(in_blocks ? 1 : 1 + steps / 20);
  std::mt19937 random(static_cast<std::mt19937::result_type>(std::hash<std::string>()(GetParam().name)));
  int kills = 0;
  while (kills < wanted) {
    fs::remove_all(folder.file("broken"));
    kills += kill_until_done(folder, checkpoint, random, whole);
    expect_same_results(folder, "whole", "broken");
    if (HasFailure()) break;
  }
  RecordProperty("kills", kills);
}

/// Phases of contacts, the anchors of stick springs and the rows of impacts and wear go on as in the unbroken run.
TEST(ResumeInARing, EndsLikeTheUnbrokenOne) {
  const std::string regularised = "slip_speed = 0.01", stick = "static_coefficient = 0.3, stick_stiffness = 1e6";
  const std::vector<std::pair<std::string, std::string>> cases = {{"rodas4", regularised}, {"exponential", regularised},
                                                                  {"exact", regularised},  {"rodas4", stick},
                                                                  {"dopri5", stick},       {"exact", stick}};
  std::mt19937 random(5);
  for (const auto& [method, friction] : cases) {
    const TemporaryFolder folder;
    const std::string keys =
        "type = \"" + method + "\"\n" + (method == "exact" ? "time_step = 1e-4\n" : "tolerance = 1e-6\n");
    folder.write("scene.toml", ring_scene(keys, friction));
    const auto begin = std::chrono::steady_clock::now();
    const Outcome unbroken = run_program({"run", "scene.toml", "-o", "whole", "-q"}, folder.path());
    ASSERT_EQ(unbroken.status, 0) << unbroken.output;
    const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin);
    EXPECT_GT(results(folder.file("whole/summary.json"))["contacts"].get<int>(), 0);
    const std::int64_t steps = results(folder.file("whole/summary.json"))["steps"];
    const std::string checkpoint = "output.checkpoint=" + std::to_string(1 + steps / 20);
    for (int kills = 0; kills < 2;) {
      fs::remove_all(folder.file("broken"));
      kills += kill_until_done(folder, checkpoint, random, whole);
      expect_same_results(folder, "whole", "broken");
      EXPECT_TRUE(read_file(folder.file("whole/wear.csv")) == read_file(folder.file("broken/wear.csv"))) << method;
      ASSERT_FALSE(HasFailure()) << method << " " << friction;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Resume, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

class Checkpointed : public testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments) { return run_program(arguments, folder_.path()); }
  /// A run that a signal stopped midway.
  void interrupt(int signal) {
    fs::remove_all(folder_.file("broken"));
    folder_.write("scene.toml", scene_of(kMethod, 100.0, 50));
    Process process({"run", "scene.toml", "-o", "broken", "-q"}, folder_.path());
    while (!fs::exists(folder_.file("broken/checkpoint-before.bin")) && !process.ends_within(1ms)) continue;
    process.send(signal);
    EXPECT_EQ(process.wait(), 1);
  }
  Json summary() const { return Json::parse(read_file(folder_.file("broken/summary.json"))); }

  const MethodCase kMethod{"newmark_modified", "", 2.0};
  TemporaryFolder folder_;
};

TEST_F(Checkpointed, ASignalEndsARunAfterItsStep) {
  for (const int signal : {SIGINT, SIGTERM}) {
    interrupt(signal);
    EXPECT_EQ(summary()["status"], "failed");
    const std::string message = summary()["message"];
    EXPECT_NE(message.find(signal == SIGINT ? "interrupted by SIGINT" : "interrupted by SIGTERM"), std::string::npos)
        << message;
    EXPECT_EQ(read_file(folder_.file("broken/history.csv")).back(), '\n');
    EXPECT_TRUE(fs::exists(folder_.file("broken/checkpoint.bin")));
    EXPECT_TRUE(fs::exists(folder_.file("broken/impacts.csv")));
  }
}

/// `timeout` signals the program and then its group: twice within microseconds.
TEST_F(Checkpointed, TwoSignalsAtOnceAreOne) {
  folder_.write("scene.toml", scene_of(kMethod, 100.0, 50));
  Process process({"run", "scene.toml", "-o", "broken", "-q"}, folder_.path());
  while (!fs::exists(folder_.file("broken/checkpoint-before.bin")) && !process.ends_within(1ms)) continue;
  process.send(SIGTERM);
  std::this_thread::sleep_for(20us);
  process.send(SIGTERM);
  EXPECT_EQ(process.wait(), 1);
  EXPECT_EQ(summary()["status"], "failed");
}

/// The results of another version are kept as they are.
TEST_F(Checkpointed, AnotherVersionIsRefused) {
  interrupt(SIGINT);
  const std::string version = BUTEE_VERSION, history = read_file(folder_.file("broken/history.csv"));
  for (const char* name : {"broken/checkpoint.bin", "broken/checkpoint-before.bin"}) {
    std::string text = read_file(folder_.file(name));
    const auto place = text.find(version);
    ASSERT_NE(place, std::string::npos);
    folder_.write(name, text.replace(place, version.size(), std::string(version.size(), '9')));
  }
  const Outcome outcome = run({"run", "--resume", "broken", "-q"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("resume with that version, or run the model again"), std::string::npos)
      << outcome.errors;
  EXPECT_TRUE(fs::exists(folder_.file("broken/checkpoint.bin")));
  EXPECT_EQ(read_file(folder_.file("broken/history.csv")), history);
}

/// A run of a hundred seconds was interrupted; its end time was then changed by hand. Resuming is refused,
/// because the model has changed.
TEST_F(Checkpointed, AnotherModelIsRefused) {
  interrupt(SIGINT);
  std::string model = read_file(folder_.file("broken/model.toml"));
  const auto at = model.find("end_time = 100");
  ASSERT_NE(at, std::string::npos);
  folder_.write("broken/model.toml", model.replace(at, 14, "end_time = 101"));
  const Outcome outcome = run(kResume);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("is not the model"), std::string::npos) << outcome.errors;
}

TEST_F(Checkpointed, DamagedCheckpointsAreToldAndPassedOver) {
  constexpr int kTrials = 100;
  folder_.write("scene.toml", scene_of(kMethod, 2e-2, 50));
  ASSERT_EQ(run({"run", "scene.toml", "-o", "whole", "-q"}).status, 0);
  for (const bool both : {false, true}) {
    bool is_interrupted = false;
    for (int trial = 0; trial < kTrials && !is_interrupted; ++trial) {  // It may finish before the signal.
      fs::remove_all(folder_.file("broken"));
      Process process({"run", "scene.toml", "-o", "broken", "-q"}, folder_.path());
      while (!fs::exists(folder_.file("broken/checkpoint-before.bin")) && !process.ends_within(100us)) continue;
      process.send(SIGKILL);
      process.wait();
      is_interrupted = fs::exists(folder_.file("broken/checkpoint.bin"));
    }
    ASSERT_TRUE(is_interrupted);
    folder_.write("broken/checkpoint.bin", "no checkpoint");
    if (both) folder_.write("broken/checkpoint-before.bin", "neither");
    const Outcome outcome = run(kResume);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find("checkpoint.bin: "), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("checkpoint-before.bin: ") != std::string::npos, both) << outcome.errors;
    expect_same_results(folder_, "whole", "broken");
  }
}

/// A kill before the model file was in place: the folder counts as empty.
TEST_F(Checkpointed, TheDraftOfAModelIsNoHindrance) {
  fs::create_directory(folder_.file("broken"));
  folder_.write("broken/model.toml.part", "# but");
  folder_.write("scene.toml", scene_of(kMethod, 1e-3, 5));
  EXPECT_EQ(run({"run", "scene.toml", "-o", "broken", "-q"}).status, 0);
  EXPECT_FALSE(fs::exists(folder_.file("broken/model.toml.part")));
  fs::create_directory(folder_.file("other"));
  folder_.write("other/model.toml.part", "");
  folder_.write("other/mine", "");
  EXPECT_EQ(run({"run", "scene.toml", "-o", "other", "-q"}).status, 2);
}

TEST_F(Checkpointed, WhatCannotGoOnSaysSo) {
  EXPECT_EQ(run({"run", "--resume", "nowhere"}).status, 2);
  folder_.write("scene.toml", scene_of(kMethod, 1e-3, 0));
  ASSERT_EQ(run({"run", "scene.toml", "-o", "broken", "-q"}).status, 0);
  const Outcome complete = run({"run", "--resume", "broken"});
  EXPECT_EQ(complete.status, 0);
  EXPECT_NE(complete.errors.find("nothing remains to be done"), std::string::npos) << complete.errors;
  fs::remove(folder_.file("broken/summary.json"));
  const Outcome without = run(kResume);
  EXPECT_EQ(without.status, 2);
  EXPECT_NE(without.errors.find("saved no checkpoints"), std::string::npos) << without.errors;
  EXPECT_EQ(run({"run", "scene.toml", "--resume", "broken"}).status, 2);
  EXPECT_EQ(run({"run", "--resume", "broken", "--set", "integrator.end_time=2.0"}).status, 2);
}

TEST_F(Checkpointed, AMethodWithAHistoryOfItsOwnIsRefused) {
  if (!fs::exists(std::string(BUTEE_TEST_PLUGINS) + "/sundials.so")) GTEST_SKIP() << "built without SUNDIALS";
  for (const char* method : {"cvode_bdf", "cvode_adams", "arkode_erk", "arkode_dirk"}) {
    folder_.write("scene.toml", scene_of({method, "", 0.0}, 1e-3, 5));
    const Outcome outcome = run({"run", "scene.toml", "-o", "broken"});
    EXPECT_EQ(outcome.status, 2) << outcome.errors;
    EXPECT_NE(outcome.errors.find("output.checkpoint"), std::string::npos) << outcome.errors;
    EXPECT_FALSE(fs::exists(folder_.file("broken")));
  }
}

TEST_F(Checkpointed, ACompletedRunLeavesNone) {
  folder_.write("scene.toml", scene_of(kMethod, 5e-3, 5));
  ASSERT_EQ(run({"run", "scene.toml", "-o", "broken", "-q", "--repeat", "2"}).status, 0);
  for (const auto& entry : fs::directory_iterator(folder_.file("broken")))
    EXPECT_FALSE(entry.path().filename().string().starts_with("checkpoint")) << entry.path();
}

}  // namespace
}  // namespace butee::test::resume_test

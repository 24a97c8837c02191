#include <string>

#include <gtest/gtest.h>

#include "stress/suite/long_runs.hpp"
#include "stress/suite/tally.hpp"

namespace butee::stress::stress_test {
namespace {

/// Evaluations and solves of a run, which is cut there: some ten thousand steps of a small scene.
constexpr std::int64_t kWork = 20000;
/// The sanitizers, under which a run takes ten times as long, see every fourth scene of a list and the ends of each
/// axis: they look at the code, and the numbers are the optimised build's to check.
#ifdef __SANITIZE_ADDRESS__
constexpr std::uint64_t kEvery = 4;
constexpr int kPoints = 2;
#else
constexpr std::uint64_t kEvery = 1;
constexpr int kPoints = 3;  ///< along an axis of the corners
#endif

void expect_no_failure(const Tally& tally, std::size_t scenes) {
  for (const Failure& f : tally.failures()) {
    ADD_FAILURE() << f.scene << ", " << f.method << ": " << name_of(f.outcome.verdict) << ", error " << f.outcome.error
                  << ", allowed " << f.outcome.allowed << " " << f.outcome.message;
  }
  EXPECT_EQ(tally.scenes, static_cast<std::int64_t>(scenes));
  EXPECT_EQ(tally.rows().size(), methods().size());
  for (const auto& [name, row] : tally.rows()) {
    EXPECT_EQ(row.runs, tally.scenes) << name;
    if (kEvery > 1) continue;
    EXPECT_GT(row.counts[static_cast<std::size_t>(Verdict::correct)], 0) << name << " never was correct";
  }
  EXPECT_GT(tally.count(Verdict::diagnosed), 0);
}

TEST(Stress, CornersOfTheSpaceOfScenes) {
  const auto scenes = corner_scenes(kPoints);
  Tally tally;
  run_all(scenes, methods(), kWork, tally);
  expect_no_failure(tally, scenes.size());
}

TEST(Stress, RandomScenes) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= 40; seed += kEvery) scenes.push_back(random_scene(seed));
  Tally tally;
  run_all(scenes, methods(), kWork, tally);
  expect_no_failure(tally, scenes.size());
}

/// Scenes that once got a wrong answer, or grew without a word, in a wider run.
TEST(Stress, ScenesThatWereWrongOnce) {
  Tally tally;
  std::vector<Scene> scenes;
  const std::vector<std::uint64_t> seeds = {99U,   252U,  268U,  453U,  490U,  504U,  522U,  558U,  695U,  943U,  1584U,
                                            1653U, 2225U, 2282U, 2773U, 3075U, 3419U, 3617U, 3921U, 4297U, 4726U, 4833U,
                                            5235U, 6043U, 6260U, 6600U, 8033U, 8039U, 9260U, 9493U, 9625U, 9773U};
  for (std::size_t i = 0; i < seeds.size(); i += kEvery) scenes.push_back(random_scene(seeds[i]));
  run_all(scenes, methods(), kWork, tally);
  expect_no_failure(tally, scenes.size());
}

TEST(Stress, LongRunsStayWithinTheirMotion) {
  for (const Method& method : methods()) {
    const LongRun run = run_long(method, 20000);
    EXPECT_TRUE(run.is_sound) << method.name << ": " << run.message;
    EXPECT_GT(run.steps, 1000) << method.name;
  }
}

TEST(StressScenes, AreTheSameForTheSameSeed) {
  EXPECT_EQ(random_scene(7).toml, random_scene(7).toml);
  EXPECT_NE(random_scene(7).toml, random_scene(8).toml);
  // The generator's own numbers: another machine makes the same scenes.
  Random random(1);
  EXPECT_EQ(random.next(), 0x910a2dec89025cc1U);
}

}  // namespace
}  // namespace butee::stress::stress_test

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "stress/long_runs.hpp"
#include "stress/tally.hpp"

namespace butee::stress {
namespace {

/// Evaluations and solves of a run, which is cut there: some ten thousand steps of a small scene.
constexpr std::int64_t kWork = 20000;

/// What is known to go wrong and not mended yet (see the README): of a stop of 1e8 and more N/m, impacts that last a
/// fraction of the steps that the tolerance leaves; of lambda = 1e14, `exact` or all others, which agree among
/// themselves. Everything else that goes wrong is a failure.
const std::set<std::pair<std::string, std::string>>& known_failures() {
  static const auto list = [] {
    std::set<std::pair<std::string, std::string>> known = {
        {"closed at the start, stop 1e14", "auto"},
        {"closed at the start, stop 1e14", "exponential"},
        {"closed at the start, stop 1e8", "generalized_alpha_adaptive"},
        {"stop's stiffness 1e14", "hht_alpha_adaptive"},
        {"stop's stiffness 1e8", "generalized_alpha_adaptive"},
        {"random 5", "generalized_alpha_adaptive"},
        {"random 7", "auto"},
        {"random 7", "exponential"},
        {"random 7", "rodas4"},
        {"random 8", "rodas4"},
        {"random 12", "generalized_alpha_adaptive"},
        {"random 12", "hht_alpha_adaptive"},
        {"random 14", "generalized_alpha_adaptive"}};
    for (const char* method :
         {"auto", "bathe_adaptive", "central_differences_adaptive", "discrete_gradient_adaptive", "dopri5",
          "exponential", "extrapolation8", "generalized_alpha_adaptive", "hht_alpha_adaptive", "rodas4"})
      known.emplace("lambda 1e14", method);
    return known;
  }();
  return list;
}

void expect_no_failure(const Tally& tally, std::size_t scenes) {
  for (const Failure& f : tally.failures()) {
    const bool is_known = f.outcome.verdict == Verdict::wrong && known_failures().contains({f.scene, f.method});
    if (is_known) continue;
    ADD_FAILURE() << f.scene << ", " << f.method << ": " << name_of(f.outcome.verdict) << ", error " << f.outcome.error
                  << ", allowed " << f.outcome.allowed << " " << f.outcome.message;
  }
  EXPECT_EQ(tally.scenes, static_cast<std::int64_t>(scenes));
  EXPECT_EQ(tally.rows().size(), methods().size());
  for (const auto& [name, row] : tally.rows()) {
    EXPECT_EQ(row.runs, tally.scenes) << name;
    EXPECT_GT(row.counts[static_cast<std::size_t>(Verdict::correct)], 0) << name << " never was correct";
  }
  EXPECT_GT(tally.count(Verdict::diagnosed), 0);
}

TEST(Stress, CornersOfTheSpaceOfScenes) {
  const auto scenes = corner_scenes(3);
  Tally tally;
  run_all(scenes, methods(), kWork, tally);
  expect_no_failure(tally, scenes.size());
}

TEST(Stress, RandomScenes) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) scenes.push_back(random_scene(seed));
  Tally tally;
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
}  // namespace butee::stress

// The stress suite as a program: butee_stress --full [--report FILE]. Without --full it runs the reduced
// suite of ctest.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>

#include <CLI/CLI.hpp>
#include <butee/core/text.hpp>

#include "stress/suite/long_runs.hpp"
#include "stress/suite/slope.hpp"
#include "stress/suite/tally.hpp"
#include "stress/suite/wide_scenes.hpp"

namespace {

using namespace butee::stress;

/// Ends the program and prints the current scene and method if a run neither ends nor is cut.
class Watchdog {
 public:
  explicit Watchdog(int seconds) : seconds_(seconds), thread_([this] { watch(); }) {}
  ~Watchdog() {
    is_done_ = true;
    thread_.join();
  }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    what_ = what;
    ++count_;
  }

 private:
  void watch() {
    long last = -1;
    int still = 0;
    while (!is_done_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      const long now = count_;
      still = now == last ? still + 1 : 0;
      last = now;
      if (still < 5 * seconds_) continue;
      const std::lock_guard lock(mutex_);
      std::fprintf(stderr, "hung after %s\n", what_.c_str());
      std::_Exit(1);
    }
  }

  int seconds_;
  std::mutex mutex_;
  std::string what_ = "the start";
  std::atomic<long> count_ = 0;
  std::atomic<bool> is_done_ = false;
  std::thread thread_;
};

/// Work limit of runs for slopes; large enough for them to complete.
constexpr std::int64_t kSlopeWork = 2000000;

struct Options {
  bool full = false, no_long_runs = false, verbose = false;
  int scenes = 0, points = 0, slopes = -1;
  std::uint64_t seed = 1;
  std::int64_t work = 0;
  std::vector<std::string> methods;
  std::string only, report;
};

int run_suite(Options options) {
  if (options.scenes == 0) options.scenes = options.full ? 10000 : 40;
  if (options.points == 0) options.points = options.full ? 13 : 3;
  if (options.slopes < 0) options.slopes = !options.only.empty() ? 0 : options.full ? 200 : 5;
  if (options.work == 0) options.work = options.full ? 100000 : 20000;
  std::vector<Method> chosen;
  for (const Method& method : methods())
    if (options.methods.empty() ||
        std::find(options.methods.begin(), options.methods.end(), method.name) != options.methods.end())
      chosen.push_back(method);

  Watchdog watchdog(options.slopes > 0 ? 3600 : 600);
  Tally corners, random;
  const auto note = [&](const Scene& scene, const Method& method, const Outcome& outcome) {
    watchdog.note(scene.name + ", " + method.name);
    if (options.verbose || is_failure(outcome.verdict))
      std::printf("%s, %s: %s, error %g, %g times the allowed error, %g of the run, %s\n", scene.name.c_str(),
                  method.name.c_str(), name_of(outcome.verdict), outcome.error, outcome.excess, outcome.part,
                  outcome.message.c_str());
    std::fflush(stdout);
  };
  std::vector<Scene> scenes;
  for (Scene& scene : corner_scenes(options.points))
    if (options.only.empty() || scene.name == options.only) scenes.push_back(std::move(scene));
  run_all(scenes, chosen, options.work, corners, note);
  const auto run_one = [&](Scene scene) {
    if (options.verbose)
      std::printf("%s, tolerance %.17g, end time %.17g\n%s", scene.name.c_str(), scene.tolerance, scene.end_time,
                  scene.toml.c_str());
    run_all({std::move(scene)}, chosen, options.work, random, note);
  };
  if (options.only.empty())
    for (int i = 0; i < options.scenes; ++i) run_one(mixed_scene(options.seed + static_cast<std::uint64_t>(i)));
  else if (std::optional<Scene> scene = random_scene_of(options.only))
    run_one(std::move(*scene));
  std::string text = "# Stress suite\n\nMade by `butee_stress" + std::string(options.full ? " --full" : "") +
                     "`, seed " + std::to_string(options.seed) + ", at most " + std::to_string(options.work) +
                     " evaluations and solves a run. Meaning of the columns: tests/stress/README.md.\n\n## Corners, " +
                     std::to_string(corners.scenes) + " scenes\n\n" + corners.markdown() + "\n## Random scenes, " +
                     std::to_string(random.scenes) + "\n\n" + random.markdown();
  bool is_good = corners.failures().empty() && random.failures().empty();
  std::string rows;
  std::int64_t fitted = 0, below = 0;
  for (int i = 0; i < options.slopes; ++i) {
    const Scene scene = mixed_scene(options.seed + static_cast<std::uint64_t>(i));
    watchdog.note("slopes of " + scene.name);
    for (const Slope& slope : slopes(scene, chosen, kSlopeWork)) {
      fitted += slope.is_fitted() ? 1 : 0;
      if (slope.is_kept()) continue;
      ++below;
      std::string row = "| " + slope.scene + " | `" + slope.method + "` | " + butee::to_short_text(slope.value) + " |";
      for (std::size_t k = 0; k < slope.errors.size(); ++k)
        row += " " + butee::to_short_text(slope.tolerances[k]) + ": " + butee::to_short_text(slope.errors[k]);
      row += " |\n";
      std::printf("%s", row.c_str());
      std::fflush(stdout);
      rows += row;
    }
  }
  if (options.slopes > 0)
    text += "\n## Slopes\n\n" + std::to_string(fitted) + " fitted on " + std::to_string(options.slopes) + " scenes, " +
            std::to_string(below) +
            " below 0.8, or 0.5 with grazing\n\n| scene | method | slope | tolerance: error |\n|---|---|---|---|\n" +
            rows;
  if (!options.no_long_runs) {
    text += "\n## Long runs\n\n| method | steps | sound | result | CPU s |\n|---|---|---|---|---|\n";
    for (const Method& method : chosen) {
      const LongRun run = run_long(method, options.full ? 1000000 : 20000);
      watchdog.note("the long run of " + method.name);
      is_good = is_good && run.is_sound;
      text += "| `" + method.name + "` | " + std::to_string(run.steps) + " | " + (run.is_sound ? "yes" : "NO") + " | " +
              run.message + " | " + std::to_string(run.seconds) + " |\n";
    }
  }
  std::printf("%s", text.c_str());
  if (!options.report.empty()) std::ofstream(options.report) << text;
  return is_good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("butee_stress: runs every method on extreme scenes");
  Options options;
  program.add_flag("--full", options.full, "ten thousand random scenes instead of forty");
  program.add_flag("--no-long-runs", options.no_long_runs, "omit the runs of very many steps");
  program.add_flag("-v,--verbose", options.verbose, "every run");
  program.add_option("--scenes", options.scenes, "the number of random scenes");
  program.add_option("--slopes", options.slopes, "the number of random scenes over all tolerances");
  program.add_option("--points", options.points, "the number of points of each sweep");
  program.add_option("--seed", options.seed, "the seed of the first random scene");
  program.add_option("--work", options.work, "the largest number of evaluations and solves of a run");
  program.add_option("--method", options.methods, "only these methods");
  program.add_option("--only", options.only, "only the scene of this name");
  program.add_option("--report", options.report, "a file for the report");
  CLI11_PARSE(program, argc, argv);
  return run_suite(options);
}

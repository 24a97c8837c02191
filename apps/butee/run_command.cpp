#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <butee/config/file_reference.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/terminal.hpp>
#include <butee/core/text.hpp>
#include <butee/run/check_start.hpp>

#include "commands.hpp"
#include "interruption.hpp"
#include "plot/draw.hpp"
#include "run.hpp"
#include "trust.hpp"

namespace butee::app {
namespace {

struct RunArguments {
  ModelArguments model;
  std::string folder;  ///< empty: "<model stem>-results"
  std::string resume;  ///< a result folder to resume
  int repeat = 1;
  bool trust = false;  ///< sets [output] trust
  bool plot = false;   ///< draw the pictures that the results allow
  std::string progress = "auto";
};

void print(const record::Summary& summary, const scene::Scene& session, const std::string& folder) {
  const auto& report = summary.report;
  if (!session.model.title.empty()) std::printf("%s\n", printable(session.model.title).c_str());
  if (!summary.choice.empty()) std::printf("  chosen: %s\n", summary.choice.c_str());
  std::printf("  %s, %td free DOF%s, %td stop%s\n", summary.integrator.c_str(), summary.dofs,
              summary.dofs == 1 ? "" : "s", summary.contacts, summary.contacts == 1 ? "" : "s");
  std::printf("  %s at t = %s s: %lld steps, %lld rejected, %lld Newton iterations\n",
              report.completed ? "completed" : "FAILED", to_short_text(report.t_end).c_str(),
              static_cast<long long>(report.steps), static_cast<long long>(report.rejected),
              static_cast<long long>(report.newton_iterations));
  std::printf("  set-up %s s, integration %s s\n", to_short_text(summary.setup_seconds).c_str(),
              to_short_text(report.wall_seconds).c_str());
  for (const auto& [column, value] : summary.peaks)
    std::printf("  largest |%s| = %s\n", column.c_str(),
                std::isfinite(value) ? to_short_text(value).c_str() : "beyond the range of numbers");
  if (summary.followed && std::isfinite(summary.followed->balance_error))
    std::printf("  energy balance error %s\n", to_short_text(summary.followed->balance_error).c_str());
  if (summary.trust) std::fputs(record::describe(*summary.trust).c_str(), stdout);
  std::printf("  results in %s\n", folder.c_str());
}

/// Repeats the integration for timing alone, and keeps the shortest time.
void repeat(scene::Scene& session, int times, bool with_progress, record::Summary& best) {
  for (int i = 1; i < times && best.report.completed; ++i) {
    const record::Summary next = Run(session, with_progress).perform(nullptr);
    if (!next.report.completed) return log::warning("repetition " + std::to_string(i + 1) + ": " + next.report.message);
    best.setup_seconds = std::min(best.setup_seconds, next.setup_seconds);
    best.report.wall_seconds = std::min(best.report.wall_seconds, next.report.wall_seconds);
  }
}

int run(scene::Scene& session, const RunArguments& arguments, const record::ResultFolder& folder) {
  plot::Request pictures;
  if (arguments.plot) plot::require_gnuplot(pictures.formats);
  for (const std::string& warning : session.warnings) log::warning(warning);
  session.output.trust = session.output.trust || arguments.trust;
  check_checkpoints(session);
  run::check_start(session, folder);
  const bool goes_on = !arguments.resume.empty();
  std::optional<record::FolderLock> lock;
  if (goes_on) lock.emplace(folder.lock());
  const auto checkpoint = goes_on ? record::CheckpointFolder(folder).newest() : std::nullopt;
  if (goes_on)
    log::info(checkpoint ? "resuming from t = " + to_short_text(checkpoint->snapshot.state.t) + " s"
                         : "there is no checkpoint yet: the run starts again");
  const bool with_progress =
      arguments.progress == "always" || (arguments.progress == "auto" && is_terminal(stderr) && !log::is_quiet());
  Run first(session, with_progress);
  watch_for_interruption();
  if (!lock) lock.emplace(folder.lock());
  if (!checkpoint) folder.prepare(config::write_toml(config::with_files_found_from(session.document, folder.path())));
  record::Summary best = first.perform(&folder, checkpoint ? &*checkpoint : nullptr);
  repeat(session, arguments.repeat, with_progress, best);
  folder.write("summary.json", record::to_json(best));
  if (best.report.completed) record::CheckpointFolder(folder).clear();
  if (session.output.trust && best.report.completed) {
    log::info("running the scene several more times to estimate its accuracy");
    best.trust = find_trust(session);
    folder.write("summary.json", record::to_json(best));
  }
  if (!log::is_quiet()) print(best, session, folder.path());
  for (const std::string& warning : best.report.warnings) log::warning(warning);
  if (arguments.plot) {
    pictures.folders = {folder.path()};
    for (const std::string& file : plot::draw(pictures, session.catalogue))
      if (!log::is_quiet()) std::printf("  picture %s\n", file.c_str());
  }
  if (best.report.completed) return kDone;
  log::error("the run failed: " + best.report.message + ". Partial results are in " + folder.path() +
             (interruption() != nullptr && session.output.checkpoint > 0
                  ? "; butee run --resume " + folder.path() + " continues it"
                  : ""));
  return kFailed;
}

int run_command(const RunArguments& arguments) {
  if (!arguments.resume.empty()) {
    const record::ResultFolder folder(arguments.resume);
    folder.check_is_ours();
    if (folder.is_complete()) {
      log::info(folder.path() + ": the run is complete, nothing remains to be done");
      return kDone;
    }
    scene::Scene session = open_session({folder.file("model.toml"), {}, arguments.model.plugins});
    if (session.output.checkpoint == 0)
      throw InputError(
          folder.path() +
          ": the run saved no checkpoints ([output] checkpoint), so it cannot be resumed; run it again: butee run " +
          folder.file("model.toml") + " -o DIR");
    return run(session, arguments, folder);
  }
  if (arguments.model.model.empty())
    throw InputError("butee run: name a model file, or a folder of results with --resume");
  scene::Scene session = open_session(arguments.model);
  const record::ResultFolder folder(!arguments.folder.empty()
                                        ? arguments.folder
                                        : std::filesystem::path(arguments.model.model).stem().string() + "-results");
  folder.check();
  return run(session, arguments, folder);
}

}  // namespace

Command add_run_command(CLI::App& program) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* app = program.add_subcommand("run", "integrate a model and write its results");
  add_model_arguments(*app, arguments->model);
  auto* output =
      app->add_option("-o,--output", arguments->folder, "the folder for the results; default <model>-results")
          ->type_name("DIR");
  auto* repeat = app->add_option("--repeat", arguments->repeat, "integrate N times and report the fastest")
                     ->check(CLI::Range(1, 1000000))
                     ->type_name("N");
  auto* model = app->get_option("model")->required(false);
  app->add_option("--resume", arguments->resume,
                  "continue the run in DIR, instead of a model, from its newest checkpoint")
      ->type_name("DIR")
      ->excludes(model)
      ->excludes(app->get_option("--set"))
      ->excludes(output)
      ->excludes(repeat);
  app->add_flag("--trust", arguments->trust,
                "estimate the accuracy of the result: runs the scene again, also by another method");
  app->add_flag("--plot", arguments->plot, "draw the results, as `butee plot` does, into plots in the result folder");
  app->add_option("--progress", arguments->progress, "a progress bar on a terminal; always: lines in a log too")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  add_log_options(*app, true);
  return {app, [arguments] { return run_command(*arguments); }};
}

}  // namespace butee::app

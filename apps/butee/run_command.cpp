#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/record/history.hpp>
#include <butee/record/impacts.hpp>
#include <butee/record/progress.hpp>
#include <butee/record/result_folder.hpp>
#include <butee/record/summary.hpp>

#include "commands.hpp"
#include "trust.hpp"

namespace butee::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// One integration from assembly to the end.
class Run {
 public:
  /// Assembles and takes the first factorization; nothing is written yet. Throws InputError where the scene cannot be
  /// run.
  Run(Session& session, bool with_progress) : session_(session), with_progress_(with_progress), begin_(Clock::now()) {
    const plugin::IntegratorChoice& choice = session.integrator;
    system_.emplace(assemble(session.model));
    dynamics_.emplace(*system_);
    integrator_ = session.catalogue.load(choice.name).make(choice.parameters, *dynamics_);
    simulation_.emplace(*dynamics_, *integrator_, choice.options);
    simulation_->start();
    summary_.setup_seconds = seconds_since(begin_);
  }

  /// Integrates; the files go to `folder` where one is given.
  record::Summary perform(const record::ResultFolder* folder) {
    attach_observers(folder);
    summary_.report = simulation_->run();
    summarize();
    if (folder != nullptr) write_files(*folder);
    return std::move(summary_);
  }

 private:
  void attach_observers(const record::ResultFolder* folder) {
    const record::OutputRequest& output = session_.output;
    const double end_time = session_.integrator.options.end_time;
    if (folder != nullptr) writer_.emplace(folder->file("history.csv"), record::HistoryRecorder::columns(output));
    history_.emplace(output, end_time, *dynamics_, writer_ ? &*writer_ : nullptr);
    simulation_->add(*history_);
    if (output.energy) simulation_->add(energy_.emplace(*dynamics_));
    if (output.impacts) simulation_->add(impacts_.emplace(*dynamics_));
    if (with_progress_) simulation_->add(progress_.emplace(end_time));
  }

  void summarize() {
    summary_.integrator = session_.integrator.name;
    summary_.choice = integrator_->choice();
    summary_.counters = dynamics_->counters();
    summary_.dofs = dynamics_->size();
    summary_.contacts = dynamics_->stop_count();
    summary_.peaks = history_->peaks();
    summary_.energy = record::energy_of(simulation_->state(), *dynamics_);
    if (energy_) summary_.followed = {energy_->work(), energy_->dissipated(), energy_->balance_error()};
  }

  void write_files(const record::ResultFolder& folder) {
    writer_->close();
    if (!impacts_) return;
    record::CsvWriter writer(folder.file("impacts.csv"), record::ImpactRecorder::columns());
    for (const record::Impact& impact : impacts_->impacts()) writer.line(record::ImpactRecorder::csv_line(impact));
    writer.close();
  }

  Session& session_;
  bool with_progress_;
  Clock::time_point begin_;
  std::optional<model::System> system_;
  std::optional<solve::Dynamics> dynamics_;
  std::unique_ptr<time::Integrator> integrator_;
  std::optional<time::Simulation> simulation_;
  record::Summary summary_;
  std::optional<record::CsvWriter> writer_;
  std::optional<record::HistoryRecorder> history_;
  std::optional<record::EnergyRecorder> energy_;
  std::optional<record::ImpactRecorder> impacts_;
  std::optional<record::ProgressBar> progress_;
};

struct RunArguments {
  ModelArguments model;
  std::string folder;  ///< empty: "<model stem>-results"
  int repeat = 1;
  bool trust = false;  ///< as [output] trust
  std::string progress = "auto";
};

void print(const record::Summary& summary, const Session& session, const std::string& folder) {
  const auto& report = summary.report;
  if (!session.model.title.empty()) std::printf("%s\n", session.model.title.c_str());
  if (!summary.choice.empty()) std::printf("  chosen: %s\n", summary.choice.c_str());
  std::printf("  %s, %td free DOFs, %td stops\n", summary.integrator.c_str(), summary.dofs, summary.contacts);
  std::printf("  %s at t = %s s: %lld steps, %lld rejected, %lld Newton iterations\n",
              report.completed ? "completed" : "FAILED", to_short_text(report.t_end).c_str(),
              static_cast<long long>(report.steps), static_cast<long long>(report.rejected),
              static_cast<long long>(report.newton_iterations));
  std::printf("  set-up %s s, integration %s s\n", to_short_text(summary.setup_seconds).c_str(),
              to_short_text(report.wall_seconds).c_str());
  for (const auto& [column, value] : summary.peaks)
    std::printf("  largest |%s| = %s\n", column.c_str(), to_short_text(value).c_str());
  if (summary.followed)
    std::printf("  energy balance error %s\n", to_short_text(summary.followed->balance_error).c_str());
  if (summary.trust) std::fputs(record::describe(*summary.trust).c_str(), stdout);
  std::printf("  results in %s\n", folder.c_str());
}

int run_command(const RunArguments& arguments) {
  Session session = open_session(arguments.model);
  session.output.trust = session.output.trust || arguments.trust;
  for (const std::string& warning : session.warnings) log::warning(warning);
  const std::string folder_name = !arguments.folder.empty()
                                      ? arguments.folder
                                      : std::filesystem::path(arguments.model.model).stem().string() + "-results";
  const record::ResultFolder folder(folder_name);
  folder.check();

  const bool with_progress =
      arguments.progress == "always" || (arguments.progress == "auto" && record::has_terminal() && !log::is_quiet());
  Run first(session, with_progress);
  folder.prepare(config::write_toml(*session.document.root.table()));
  record::Summary best = first.perform(&folder);
  for (int i = 1; i < arguments.repeat && best.report.completed; ++i) {
    const record::Summary next = Run(session, with_progress).perform(nullptr);
    best.setup_seconds = std::min(best.setup_seconds, next.setup_seconds);
    best.report.wall_seconds = std::min(best.report.wall_seconds, next.report.wall_seconds);
  }
  if (session.output.trust && best.report.completed) best.trust = find_trust(session);
  folder.write("summary.json", record::to_json(best));
  if (!log::is_quiet()) print(best, session, folder.path());
  if (best.report.completed) return kDone;
  log::error("the run failed: " + best.report.message + ". What was computed is in " + folder.path());
  return kFailed;
}

}  // namespace

Command add_run_command(CLI::App& program) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* app = program.add_subcommand("run", "integrate a model and write its results");
  add_model_arguments(*app, arguments->model);
  app->add_option("-o,--output", arguments->folder, "the folder for the results; <model>-results where not given")
      ->type_name("DIR");
  app->add_option("--repeat", arguments->repeat, "integrate N times and report the fastest")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app->add_flag("--trust", arguments->trust,
                "find out how far the answer can be trusted: runs the scene four more times");
  app->add_option("--progress", arguments->progress, "a progress bar")
      ->check(CLI::IsMember({"auto", "always", "never"}));
  add_log_options(*app, true);
  return {app, [arguments] { return run_command(*arguments); }};
}

}  // namespace butee::app

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

namespace butee::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// One integration from assembly to the end, its files written where `folder` is given.
class Run {
 public:
  Run(Session& session, const record::ResultFolder* folder, bool with_progress)
      : session_(session), folder_(folder), with_progress_(with_progress) {}

  record::Summary perform() {
    const auto begin = Clock::now();
    const model::System system = assemble(session_.scene.model);
    solve::Dynamics dynamics(system);
    const plugin::IntegratorChoice& choice = session_.scene.integrator;
    const auto integrator = session_.catalogue.load(choice.name).make(choice.parameters, dynamics);
    time::Simulation simulation(dynamics, *integrator, choice.options);
    attach_observers(simulation, dynamics);
    simulation.start();
    summary_.setup_seconds = seconds_since(begin);

    summary_.report = simulation.run();
    summarize(simulation, dynamics);
    if (folder_ != nullptr) write_files();
    return std::move(summary_);
  }

 private:
  void attach_observers(time::Simulation& simulation, solve::Dynamics& dynamics) {
    const record::OutputRequest& output = session_.output;
    const double end_time = session_.scene.integrator.options.end_time;
    if (folder_ != nullptr) writer_.emplace(folder_->file("history.csv"), record::HistoryRecorder::columns(output));
    history_.emplace(output, end_time, dynamics, writer_ ? &*writer_ : nullptr);
    simulation.add(*history_);
    if (output.energy) simulation.add(energy_.emplace(dynamics));
    if (output.impacts) simulation.add(impacts_.emplace(dynamics));
    if (with_progress_) simulation.add(progress_.emplace(end_time));
  }

  void summarize(const time::Simulation& simulation, solve::Dynamics& dynamics) {
    summary_.integrator = session_.scene.integrator.name;
    summary_.counters = dynamics.counters();
    summary_.dofs = dynamics.size();
    summary_.contacts = dynamics.stop_count();
    summary_.peaks = history_->peaks();
    summary_.energy = record::energy_of(simulation.state(), dynamics);
    if (energy_) summary_.followed = {energy_->work(), energy_->dissipated(), energy_->balance_error()};
  }

  void write_files() {
    writer_->close();
    if (!impacts_) return;
    record::CsvWriter writer(folder_->file("impacts.csv"), record::ImpactRecorder::columns());
    for (const record::Impact& impact : impacts_->impacts()) writer.line(record::ImpactRecorder::csv_line(impact));
    writer.close();
  }

  Session& session_;
  const record::ResultFolder* folder_;
  bool with_progress_;
  record::Summary summary_;
  std::optional<record::CsvWriter> writer_;
  std::optional<record::HistoryRecorder> history_;
  std::optional<record::EnergyRecorder> energy_;
  std::optional<record::ImpactRecorder> impacts_;
  std::optional<record::ProgressBar> progress_;
};

void print(const record::Summary& summary, const Session& session, const std::string& folder) {
  const auto& report = summary.report;
  if (!session.scene.model.title.empty()) std::printf("%s\n", session.scene.model.title.c_str());
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
  std::printf("  results in %s\n", folder.c_str());
}

}  // namespace

int run_command(const RunArguments& arguments) {
  Session session = open_session(arguments.model);
  for (const std::string& warning : session.warnings) log::warning(warning);
  const std::string folder_name = !arguments.folder.empty()
                                      ? arguments.folder
                                      : std::filesystem::path(arguments.model.model).stem().string() + "-results";
  const record::ResultFolder folder(folder_name);
  folder.check();
  folder.prepare(config::write_toml(*session.document.root.table()));

  const bool with_progress =
      arguments.progress == "always" || (arguments.progress == "auto" && record::has_terminal() && !log::is_quiet());
  record::Summary best = Run(session, &folder, with_progress).perform();
  for (int i = 1; i < arguments.repeat && best.report.completed; ++i) {
    const record::Summary next = Run(session, nullptr, with_progress).perform();
    best.setup_seconds = std::min(best.setup_seconds, next.setup_seconds);
    best.report.wall_seconds = std::min(best.report.wall_seconds, next.report.wall_seconds);
  }
  folder.write("summary.json", record::to_json(best));
  if (!log::is_quiet()) print(best, session, folder.path());
  if (best.report.completed) return kDone;
  log::error("the run failed: " + best.report.message + ". What was computed is in " + folder.path());
  return kFailed;
}

}  // namespace butee::app

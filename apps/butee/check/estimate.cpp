#include "estimate.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <butee/config/file_reference.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "../interruption.hpp"
#include "../run.hpp"
#include "pace.hpp"

namespace butee::app::check {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// Duration of a trial in s, and its extended duration if the shorter trial is not conclusive.
constexpr double kTrialSeconds = 0.2, kLongTrialSeconds = 1.0;
/// Fraction of the run after which an adaptive method's remaining steps can be estimated. With it, none of
/// 1392 trials of 163 runs (scenes of apps/ and their variants, six methods) gave a number of steps that was
/// wrong by a factor of 1.5.
constexpr double kEnough = 1.0 / 3.0;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A temporary folder for the files of a trial, removed by the destructor.
class TrialFolder {
 public:
  TrialFolder() : path_((fs::temp_directory_path() / "butee-check-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw RunError(path_ + ": a folder for a trial run cannot be created");
  }
  ~TrialFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TrialFolder(const TrialFolder&) = delete;
  TrialFolder& operator=(const TrialFolder&) = delete;

  std::string results() const { return path_ + "/results"; }
  /// Size of all files except the saved last state.
  double bytes() const {
    double bytes = 0.0;
    for (const auto& entry : fs::recursive_directory_iterator(path_))
      if (entry.is_regular_file() && entry.path().filename() != model::SavedMotions::kFile)
        bytes += static_cast<double>(entry.file_size());
    return bytes;
  }

 private:
  std::string path_;
};

/// Records steps and time over a trial, and whether a stop closed.
class Watcher final : public time::Observer {
 public:
  Watcher(dynamics::Dynamics& dynamics, const time::RunReport& report, double begin)
      : steps(begin),
        seconds(begin),
        dynamics_(dynamics),
        report_(report),
        stops_(dynamics.stop_count()),
        has_struck_(stops_.size() == 0) {}

  void start(const time::State&) override { started_ = Clock::now(); }
  void step(const time::AcceptedStep& step) override {
    steps.add(step.to.t, static_cast<double>(report_.steps));
    seconds.add(step.to.t, seconds_since(started_));
    if (!has_struck_) look_at_stops(step.to);
  }
  /// True if a stop was closed at the end of a step, or if there are no stops.
  bool has_struck() const { return has_struck_; }

  Pace steps, seconds;

 private:
  void look_at_stops(const time::State& state) {
    Vector penetration(stops_.size());
    dynamics_.stops().displacement(state.x, stops_);
    dynamics_.stops().penetration(stops_, penetration);
    has_struck_ = penetration.maxCoeff() > 0.0;
  }

  dynamics::Dynamics& dynamics_;
  const time::RunReport& report_;
  Vector stops_;
  bool has_struck_;
  Clock::time_point started_;
};

std::optional<double> rows_of(const model::OutputRequest& output, double span, std::optional<double> steps) {
  if (output.interval) return std::ceil(span / *output.interval - 1e-9) + 1.0;
  if (steps) return *steps / static_cast<double>(output.every) + 1.0;
  return std::nullopt;
}

void try_out(scene::Scene& session, double reading_seconds, Estimate& result) {
  const time::IntegratorType& type = session.catalogue.load(session.integrator.name);
  const double end_time = session.integrator.options.end_time;
  const auto begin = Clock::now();
  const TrialFolder place;
  const record::ResultFolder folder(place.results());
  Run run(session, false);
  const record::FolderLock lock = folder.lock();
  folder.prepare(config::write_toml(config::with_files_found_from(session.document, folder.path())));
  const double start = run.assembly().system.initial_time, span = end_time - start;
  Watcher watcher(run.assembly().dynamics, run.assembly().simulation.report(), start);
  run.add(watcher);
  const auto can_tell = [&] {
    const double part = (run.assembly().simulation.report().t_end - start) / span;
    return watcher.has_struck() && watcher.seconds.foretell(end_time) &&
           (type.fixed_step || (part >= kEnough && watcher.steps.foretell(end_time)));
  };
  const double bytes_before = place.bytes();
  const double setup_seconds = seconds_since(begin);
  const auto started = Clock::now();
  double limit = kTrialSeconds;
  run.stop_when([&] {
    if (seconds_since(started) < limit) return false;
    if (limit == kLongTrialSeconds || can_tell()) return true;
    limit = kLongTrialSeconds;
    return false;
  });
  const record::Summary summary = run.perform(&folder);
  result.trial_seconds = seconds_since(started);
  const time::RunReport& report = summary.report;
  if (interruption() != nullptr) throw RunError("interrupted");
  result.choice = summary.choice;
  if (!report.message.empty())
    result.failure = "a trial run failed at t = " + to_short_text(report.t_end) + " s: " + report.message;
  result.whole = report.completed;
  result.part = (report.t_end - start) / span;
  result.steps_known = type.fixed_step;
  if (result.whole)
    result.steps = static_cast<double>(report.steps);
  else if (type.fixed_step)
    result.steps = std::ceil(span / session.integrator.options.time_step * (1.0 - 1e-12));
  const bool tells = result.part > 0.0 && can_tell();
  if (tells && !result.steps) result.steps = watcher.steps.foretell(end_time);
  if (result.whole || tells) result.seconds = reading_seconds + setup_seconds + result.trial_seconds / result.part;
  const auto written = rows_of(session.output, report.t_end - start, static_cast<double>(report.steps));
  result.rows = rows_of(session.output, span, result.steps);
  if (result.rows) result.bytes = (place.bytes() - bytes_before) / *written * *result.rows;
}

}  // namespace

Estimate estimate(scene::Scene& session, double reading_seconds) {
  Estimate result;
  try {
    check_checkpoints(session);
    watch_for_interruption();
    try_out(session, reading_seconds, result);
  } catch (const InputError& error) {
    result.refusal = error.what();
  }
  return result;
}

}  // namespace butee::app::check

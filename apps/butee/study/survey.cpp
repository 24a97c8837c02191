#include "survey.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <butee/config/toml.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/study/perform.hpp>

#include "../json.hpp"
#include "horizon.hpp"
#include "progress_line.hpp"

namespace butee::app::studies {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMostSeconds = 2.0;  ///< longest trial, s

/// Results of trials of the first, the middle and the last run.
struct Trials {
  double seconds = 0.0;  ///< mean time of a run
  int count = 0, unfinished = 0;
  std::string reason;  ///< reason of the first run without results
};

Trials try_runs(const study::Study& study, const study::Layout& layout) {
  const log::WithoutWarnings quiet;
  Trials trials;
  study::Worker worker(study, layout);
  const std::int64_t last = study.plan.run_count() - 1;
  std::int64_t before = -1;
  for (const std::int64_t run : {std::int64_t{0}, last / 2, last}) {
    if (run == before) continue;
    before = run;
    study::Motion start;
    const auto begin = Clock::now();
    const auto past = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    const auto row = worker.perform(run, start, [&] { return past() < kMostSeconds; });
    trials.seconds += past();
    ++trials.count;
    if (!row) ++trials.unfinished;
    if (row && trials.reason.empty()) trials.reason = row->text(layout.find(study::kReasonColumn));
  }
  trials.seconds /= trials.count;
  return trials;
}

const char* name_of(study::PlanKind kind) {
  constexpr const char* kNames[] = {"grid", "list", "sobol", "latin"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

bool names_study(const std::string& path) {
  // A pipe can be read only once, and the scene reader needs it.
  if (!std::filesystem::is_regular_file(path)) return false;
  return study::is_study(config::load_toml(path));
}

void print_study_survey(const ModelArguments& arguments, bool as_json) {
  const study::Study study =
      study::load_study(arguments.model, {arguments.overrides, arguments.plugins, {}, horizon_of});
  study::check_points(study);
  const study::Layout layout = layout_of(study);
  const Trials trials = try_runs(study, layout);
  const int threads = study::processor_count();
  const auto runs = static_cast<double>(study.plan.run_count());
  const double seconds = trials.seconds * runs / threads, bytes = static_cast<double>(layout.row_bytes()) * runs;
  if (as_json) {
    Json json;
    json["points"] = study.plan.point_count();
    json["runs"] = study.plan.run_count();
    json["plan"] = name_of(study.plan.kind());
    json["estimate"] = {
        {"seconds", seconds}, {"is_least", trials.unfinished > 0}, {"threads", threads}, {"bytes", bytes}};
    for (const study::Column& column : layout.columns())
      json["columns"].push_back({{"name", column.name},
                                 {"unit", column.unit},
                                 {"entries", column.type == study::Column::Type::text ? 1 : column.length}});
    return print_json(json);
  }
  std::printf("study      %s\n", printable(study.title.empty() ? study.stem : study.title).c_str());
  std::printf("plan       %s: %lld points, %lld runs%s\n", name_of(study.plan.kind()),
              static_cast<long long>(study.plan.point_count()), static_cast<long long>(study.plan.run_count()),
              study.plan.follow() == study::Follow::no
                  ? ""
                  : (" in " + std::to_string(study.plan.chain_count()) + " sweeps").c_str());
  for (const study::Axis& axis : study.plan.axes()) {
    const bool is_open = axis.range && axis.count == 0;
    const std::string from = is_open ? to_short_text(axis.range->from) : config::to_toml(axis.value(0));
    const std::string to = is_open ? to_short_text(axis.range->to) : config::to_toml(axis.value(axis.size() - 1));
    std::printf("  %s  %s ... %s%s\n", printable(axis.key).c_str(), printable(from).c_str(), printable(to).c_str(),
                is_open ? "" : (", " + std::to_string(axis.size()) + " values").c_str());
  }
  std::printf("columns    %zu, %zu bytes a row\n", layout.columns().size(), layout.row_bytes());
  std::printf("estimate   %s%s with %d threads, %s MB (trial of %d runs)\n",
              trials.unfinished > 0 ? "more than " : "about ", time_span(seconds).c_str(), threads,
              to_short_text(std::round(bytes / 1e4) / 100.0).c_str(), trials.count);
  if (!trials.reason.empty()) log::warning("a run of the trial has no results: " + trials.reason);
}

}  // namespace butee::app::studies

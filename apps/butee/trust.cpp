#include "trust.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/record/impacts.hpp>
#include <butee/record/peaks.hpp>
#include <butee/record/probes.hpp>

#include "assembly.hpp"
#include "interruption.hpp"

namespace butee::app {
namespace {

using record::Courses;

/// Relative to the peak: small enough to grow freely, far above rounding.
constexpr double kPerturbation = 1e-9;
constexpr double kSameInstant = 1e-9;

/// What one of the runs gives.
struct Repetition {
  Courses courses;
  std::vector<record::Trust::Statistic> statistics;  ///< value alone
};

std::vector<record::ProbeRequest> displacement_probes(const Session& session) {
  std::vector<record::ProbeRequest> probes;
  for (const record::ProbeRequest& probe : session.output.probes) probes.push_back({probe.label, probe.node, {}});
  for (auto& probe : probes) probe.quantities = {record::Quantity::u};
  return probes;
}

/// Follows the displacements of the probes at the output times.
class Follower final : public time::Observer {
 public:
  Follower(const Session& session, solve::Dynamics& dynamics)
      : probes_(displacement_probes(session), dynamics), row_(probes_.columns().size()) {
    courses.values.resize(row_.size());
    const double end = session.integrator.options.end_time, interval = session.output.interval.value_or(end / 1000.0);
    for (std::size_t i = 0; static_cast<double>(i) * interval < end * (1.0 - kSameInstant); ++i)
      courses.times.push_back(static_cast<double>(i) * interval);
    courses.times.push_back(end);
  }

  void start(const time::State& state) override {
    probes_.evaluate(state, row_);
    take();
  }
  void step(const time::AcceptedStep& step) override {
    while (next_ < courses.times.size() && courses.times[next_] <= step.to.t) {
      probes_.evaluate(step, courses.times[next_], row_);
      take();
    }
  }

  Courses courses;

 private:
  void take() {
    for (std::size_t i = 0; i < row_.size(); ++i) courses.values[i].push_back(row_[i]);
    ++next_;
  }

  record::Probes probes_;
  std::vector<double> row_;
  std::size_t next_ = 0;
};

Repetition repeat(Session& session, double perturbation) {
  Assembly assembly(session, perturbation);
  solve::Dynamics& dynamics = assembly.dynamics;
  time::Simulation& simulation = assembly.simulation;
  Follower follower(session, dynamics);
  simulation.add(follower);
  const auto probes = displacement_probes(session);
  record::Peaks peaks(probes, dynamics);
  simulation.add(peaks);
  record::ImpactRecorder impacts(dynamics);
  if (dynamics.stop_count() > 0) simulation.add(impacts);
  const time::RunReport& report = simulation.run([] { return interruption() == nullptr; });
  if (interruption() != nullptr) throw RunError("interrupted while finding out how far to trust the run");
  if (!report.completed)
    throw RunError("a run that was to tell how far to trust the first one failed: " + report.message);
  Repetition result{std::move(follower.courses), {}};
  const std::map<std::string, double> largest = peaks.largest();
  for (std::size_t i = 0; i < probes.size(); ++i) {
    double squares = 0.0;
    for (const double u : result.courses.values[i]) squares += u * u;
    const double rms = std::sqrt(squares / static_cast<double>(result.courses.times.size()));
    result.statistics.push_back({"rms of " + probes[i].label + ".u", rms, 0, 0});
    result.statistics.push_back({"peak of " + probes[i].label + ".u", largest.at(probes[i].label + ".u"), 0, 0});
  }
  if (dynamics.stop_count() > 0) {
    const std::vector<record::Impact> all = impacts.impacts();
    double force = 0.0;
    for (const record::Impact& impact : all) force = std::max(force, impact.peak_force);
    result.statistics.push_back({"largest contact force", force, 0, 0});
    result.statistics.push_back({"impacts", static_cast<double>(all.size()), 0, 0});
  }
  return result;
}

/// The scene with half the step, a tenth of the tolerance, or what the method has instead.
Session tighten(const Session& session, std::string& what) {
  config::Document document = session.document;
  plugin::Catalogue catalogue = session.catalogue;
  const time::IntegratorType& type = catalogue.load(session.integrator.name);
  config::Table& integrator = *(*document.root.table())["integrator"].table();
  const auto set = [&](const std::string& key, double before, double after) {
    what = key + " " + to_short_text(before) + " -> " + to_short_text(after);
    integrator[key] = config::Value(after);
  };
  const double step = session.integrator.options.time_step;
  if (type.fixed_step) {
    set("time_step", step, 0.5 * step);
  } else {
    const auto swept = std::find_if(type.parameters.begin(), type.parameters.end(),
                                    [](const config::Parameter& parameter) { return parameter.swept.has_value(); });
    if (swept != type.parameters.end()) {
      const double before = session.integrator.parameters.number(swept->name);
      set(swept->name, before, 0.1 * before);
    } else if (step > 0.0) {
      set("time_step", step, 0.5 * step);
    } else {
      throw InputError("integrator.type: " + type.name + " has nothing that could be tightened; give it a time_step");
    }
  }
  return read_session(std::move(document), std::move(catalogue));
}

}  // namespace

record::Trust find_trust(Session& session) {
  log::info("running the scene again, four times, to see how far to trust it");
  std::string what;
  Session tightened = tighten(session, what);
  const Repetition first = repeat(session, 0.0), second = repeat(tightened, 0.0);
  double peak = 0.0;
  for (const auto& course : first.courses.values)
    for (const double value : course) peak = std::max(peak, std::abs(value));
  const double size = kPerturbation * (peak > 0.0 ? peak : 1.0);
  const Repetition third = repeat(session, size), fourth = repeat(session, -size);
  record::Trust trust =
      judge(first.courses, second.courses, {third.courses, fourth.courses}, size, session.output.trust_accuracy);
  trust.tightened = what;
  for (std::size_t i = 0; i < first.statistics.size(); ++i) {
    record::Trust::Statistic statistic = first.statistics[i];
    const auto [least, greatest] = std::minmax(
        {statistic.value, second.statistics[i].value, third.statistics[i].value, fourth.statistics[i].value});
    statistic.least = least;
    statistic.greatest = greatest;
    trust.statistics.push_back(std::move(statistic));
  }
  return trust;
}

}  // namespace butee::app

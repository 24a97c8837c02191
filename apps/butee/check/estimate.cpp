#include "estimate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <butee/record/impacts.hpp>

namespace butee::app::check {
namespace {

using Clock = std::chrono::steady_clock;

/// A trial ends when it has taken this long, and of an adaptive method that cannot be foretold yet, this long.
constexpr double kTrialSeconds = 0.2, kLongTrialSeconds = 1.0;
/// The part of the run that tells what an adaptive method does in the rest.
constexpr double kEnough = 0.05;
/// The steps in equal times of the second half of a trial may differ by this factor.
constexpr double kSteady = 1.25;
/// Characters of a number with 17 digits and its comma, on the average.
constexpr double kBytesOfNumber = 22.0;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Looks at the course of a trial.
class Pace final : public time::Observer {
 public:
  explicit Pace(solve::Dynamics& dynamics)
      : contact_(dynamics.contact()), stops_(dynamics.stop_count()), has_struck_(stops_.size() == 0) {}

  void step(const time::AcceptedStep& step) override {
    steps_ += 1.0;
    if (!has_struck_) look_at_stops(step.to);
    if (++since_last_ < stride_) return;
    since_last_ = 0;
    marks_.push_back({step.to.t, steps_});
    if (marks_.size() < kMostMarks) return;
    for (std::size_t i = 0; 2 * i + 1 < marks_.size(); ++i) marks_[i] = marks_[2 * i + 1];
    marks_.resize(marks_.size() / 2);
    stride_ *= 2;
  }
  /// Whether a stop was closed at the end of a step, if there are any.
  bool has_struck() const { return has_struck_; }
  /// Whether so many steps were taken in the last quarter of the time as in the one before.
  bool is_steady() const {
    if (marks_.empty()) return false;
    const double end = marks_.back().t;
    const auto steps_by = [&](double t) {
      const auto mark = std::lower_bound(marks_.begin(), marks_.end(), t,
                                         [](const Mark& before, double instant) { return before.t < instant; });
      return mark == marks_.end() ? steps_ : mark->steps;
    };
    const double before = steps_by(0.75 * end) - steps_by(0.5 * end), last = steps_ - steps_by(0.75 * end);
    return std::max(before, last) <= kSteady * std::min(before, last);
  }

 private:
  void look_at_stops(const time::State& state) {
    Vector penetration(stops_.size());
    contact_.displacement(state.x, stops_);
    contact_.penetration(stops_, penetration);
    has_struck_ = penetration.maxCoeff() > 0.0;
  }

  static constexpr std::size_t kMostMarks = 4096;
  struct Mark {
    double t, steps;
  };
  solve::Contact& contact_;
  Vector stops_;
  bool has_struck_;
  std::vector<Mark> marks_;
  double steps_ = 0.0;
  std::size_t since_last_ = 0, stride_ = 1;
};

void try_out(Session& session, const model::System& system, Estimate& result) {
  const plugin::IntegratorChoice& choice = session.integrator;
  const time::IntegratorType& type = session.catalogue.load(choice.name);
  const record::OutputRequest& output = session.output;
  const double end_time = choice.options.end_time;
  const auto begin = Clock::now();
  solve::Dynamics dynamics(system);
  const auto integrator = type.make(choice.parameters, dynamics);
  time::Simulation simulation(dynamics, *integrator, choice.options);
  simulation.start();
  result.choice = integrator->choice();
  result.setup_seconds = seconds_since(begin);
  // The observers of a run, which cost time and may shorten steps.
  record::HistoryRecorder history(output, end_time, dynamics, nullptr);
  record::EnergyRecorder energy(dynamics, nullptr, record::OutputTimes(output.interval, output.every, end_time));
  record::ImpactRecorder impacts(dynamics);
  Pace pace(dynamics);
  simulation.add(history);
  if (output.energy) simulation.add(energy);
  if (output.impacts) simulation.add(impacts);
  if (!type.fixed_step) simulation.add(pace);
  const auto can_tell = [&] {
    if (type.fixed_step) return true;
    return simulation.report().t_end >= kEnough * end_time && pace.has_struck() && pace.is_steady();
  };
  const auto started = Clock::now();
  double limit = kTrialSeconds;
  while (simulation.advance()) {
    if (seconds_since(started) < limit) continue;
    if (limit == kLongTrialSeconds || can_tell()) break;
    limit = kLongTrialSeconds;
  }
  result.trial_seconds = seconds_since(started);
  const time::RunReport& report = simulation.report();
  if (!report.message.empty())
    result.failure = "a trial run failed at t = " + to_short_text(report.t_end) + " s: " + report.message;
  result.whole = report.completed;
  const double span = end_time - system.initial_time;
  result.part = (report.t_end - system.initial_time) / span;
  result.steps_known = type.fixed_step;
  if (type.fixed_step && choice.options.time_step > 0.0)
    result.steps = std::ceil(span / choice.options.time_step * (1.0 - 1e-12));
  if (!(result.part > 0.0) || !(result.whole || can_tell())) return;
  result.run_seconds = result.trial_seconds / result.part;
  if (!result.steps) result.steps = static_cast<double>(report.steps) / result.part;
}

}  // namespace

Estimate estimate(Session& session, const model::System& system) {
  Estimate result;
  try {
    try_out(session, system, result);
  } catch (const InputError& error) {
    result.failure = std::string("a run of this scene is refused: ") + error.what();
  }
  const record::OutputRequest& output = session.output;
  if (output.interval)
    result.rows =
        std::ceil((session.integrator.options.end_time - system.initial_time) / *output.interval - 1e-9) + 1.0;
  else if (result.steps)
    result.rows = *result.steps / static_cast<double>(output.every) + 1.0;
  double columns = 2.0;
  for (const record::ProbeRequest& probe : output.probes) columns += static_cast<double>(probe.quantities.size());
  if (result.rows) result.bytes = *result.rows * columns * kBytesOfNumber;
  return result;
}

}  // namespace butee::app::check

#include "trial.hpp"

#include <algorithm>
#include <chrono>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/scene/assembly.hpp>

#include "../interruption.hpp"
#include "../perturb.hpp"

namespace butee::app::compare {
namespace {

using Clock = std::chrono::steady_clock;

/// Short runs are repeated until their total time reaches kReliable, s, and at least kFewestRuns times.
constexpr double kReliable = 0.1;
constexpr int kFewestRuns = 3, kMostRuns = 200;
/// Steps between two checks of the elapsed time.
constexpr int kStepsUnwatched = 64;
constexpr double kSameInstant = 1e-9;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Samples the quantities at the times of the question with the method's own interpolant.
class Sampler final : public time::Observer {
 public:
  Sampler(const Question& question, dynamics::Dynamics& dynamics)
      : question_(question), probes_(question.probes, dynamics), row_(question.columns.size()) {
    values.resize(row_.size());
  }

  void start(const time::State& state) override {
    if (!question_.times.empty() && question_.times.front() <= state.t)
      take([&](auto to) { probes_.evaluate(state, to); });
  }
  void step(const time::AcceptedStep& step) override {
    const auto begin = question_.times.begin() + static_cast<std::ptrdiff_t>(taken_);
    const auto end = std::upper_bound(begin, question_.times.end(), step.to.t);
    if (begin == end) return;
    probes_.sample(step, {begin, end});
    for (std::size_t i = 0, count = static_cast<std::size_t>(end - begin); i < count; ++i)
      take([&](auto to) { probes_.take(i, to); });
  }

  double next_instant(double t) const override {
    std::size_t next = taken_;
    while (next < question_.times.size() && question_.times[next] <= t) ++next;
    return next < question_.times.size() ? question_.times[next] : std::numeric_limits<double>::infinity();
  }

  Values values;

 private:
  template <class Evaluate>
  void take(Evaluate evaluate) {
    evaluate(std::span<double>(row_));
    for (std::size_t i = 0; i < row_.size(); ++i) values[i].push_back(row_[i]);
    ++taken_;
  }

  const Question& question_;
  record::Probes probes_;
  std::vector<double> row_;
  std::size_t taken_ = 0;
};

}  // namespace

Question question_of(const scene::Scene& session, const std::vector<std::string>& columns) {
  std::vector<std::string> known;
  std::vector<model::ProbeRequest> single;
  for (const model::ProbeRequest& probe : session.output.probes)
    for (const model::Quantity quantity : probe.quantities) {
      known.push_back(probe.label + "." + name_of(quantity));
      single.push_back({probe.label, probe.node, {quantity}, probe.element});
    }
  if (known.empty())
    throw InputError(session.document.sources.front() + ": there is nothing to compare; add an [[output.probe]]");
  Question question;
  for (const std::string& column : columns.empty() ? std::vector{known.front()} : columns) {
    const auto found = std::find(known.begin(), known.end(), column);
    if (found == known.end())
      throw InputError(session.document.sources.front() + ": there is no column \"" + column + "\"" +
                       suggestion(column, known) + "; [[output.probe]] gives " + join(known));
    question.columns.push_back(column);
    question.probes.push_back(single[static_cast<std::size_t>(found - known.begin())]);
  }
  const double begin = session.model.initial_motion ? session.model.initial_motion->time : 0.0;
  const double end = session.integrator.options.end_time;
  const double interval = session.output.interval.value_or((end - begin) / 1000.0);
  for (std::size_t i = 0; begin + static_cast<double>(i) * interval < end * (1.0 - kSameInstant); ++i)
    question.times.push_back(begin + static_cast<double>(i) * interval);
  question.times.push_back(end);
  return question;
}

Answer run_once(scene::Scene& session, const Question& question, double time_limit, double perturbation) {
  Answer answer;
  const log::WithoutWarnings quiet;  // The table reports slow or failed methods.
  const auto begin = Clock::now();
  scene::Assembly assembly(session, perturbed_by(perturbation));
  dynamics::Dynamics& dynamics = assembly.dynamics;
  time::Simulation& simulation = assembly.simulation;
  Sampler sampler(question, dynamics);
  simulation.add(sampler);
  bool goes_on = true;
  while (goes_on && interruption() == nullptr && seconds_since(begin) < time_limit)
    for (int i = 0; i < kStepsUnwatched && goes_on; ++i) goes_on = simulation.advance();
  answer.seconds = seconds_since(begin);
  answer.report = simulation.report();
  answer.completed = answer.report.completed;
  answer.message = answer.report.message;
  if (goes_on && !answer.completed) answer.message = interruption() != nullptr ? "interrupted" : "too slow";
  answer.counters = dynamics.counters();
  answer.values = std::move(sampler.values);
  return answer;
}

Answer measure(scene::Scene& session, const Question& question, double time_limit) {
  Answer best = run_once(session, question, time_limit);
  double sum = best.seconds;
  for (int i = 1; best.completed && i < kMostRuns && interruption() == nullptr; ++i) {
    if (sum > kReliable && (i >= kFewestRuns || sum > time_limit)) break;
    Answer next = run_once(session, question, time_limit);
    sum += next.seconds;
    if (next.completed && next.seconds < best.seconds) best = std::move(next);
  }
  return best;
}

}  // namespace butee::app::compare

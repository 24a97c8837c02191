#include "estimate.hpp"

#include <chrono>
#include <cmath>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::app::check {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTrialSeconds = 0.2;
/// Characters of a number with 17 digits and its comma, on the average.
constexpr double kBytesOfNumber = 22.0;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void try_out(Session& session, const model::System& system, Estimate& result) {
  const plugin::IntegratorChoice& choice = session.integrator;
  const time::IntegratorType& type = session.catalogue.load(choice.name);
  const double end_time = choice.options.end_time;
  const auto begin = Clock::now();
  solve::Dynamics dynamics(system);
  const auto integrator = type.make(choice.parameters, dynamics);
  time::Simulation simulation(dynamics, *integrator, choice.options);
  simulation.start();
  result.choice = integrator->choice();
  result.setup_seconds = seconds_since(begin);
  const auto started = Clock::now();
  while (simulation.advance() && seconds_since(started) < kTrialSeconds) {
  }
  result.trial_seconds = seconds_since(started);
  const time::RunReport& report = simulation.report();
  if (!report.message.empty())
    result.failure = "a trial run failed at t = " + to_short_text(report.t_end) + " s: " + report.message;
  result.whole = report.completed;
  const double part = (report.t_end - system.initial_time) / (end_time - system.initial_time);
  if (!(part > 0.0)) return;
  result.run_seconds = result.trial_seconds / part;
  result.steps = static_cast<double>(report.steps) / part;
  result.steps_known = type.fixed_step;
  if (type.fixed_step && choice.options.time_step > 0.0)
    result.steps = std::ceil((end_time - system.initial_time) / choice.options.time_step * (1.0 - 1e-12));
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
  const double span = session.integrator.options.end_time - system.initial_time;
  result.rows = output.interval ? std::ceil(span / *output.interval - 1e-9) + 1.0
                                : result.steps / static_cast<double>(output.every) + 1.0;
  double columns = 2.0;
  for (const record::ProbeRequest& probe : output.probes) columns += static_cast<double>(probe.quantities.size());
  result.bytes = result.rows * columns * kBytesOfNumber;
  return result;
}

}  // namespace butee::app::check

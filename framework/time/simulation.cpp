#include "butee/time/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::time {
namespace {

/// A fixed step that divides end_time to this fraction of a step divides it.
constexpr double kDivides = 1e-9;
/// An adaptive method gives up where a rejected step is shorter than this fraction of end_time.
constexpr double kSmallestStep = 1e-14;
/// No sensible control rejects one step this often; shrink factors close to 1 need many.
constexpr int kMostRejections = 5000;

using Clock = std::chrono::steady_clock;

}  // namespace

Simulation::Simulation(solve::Dynamics& dynamics, Integrator& integrator, SimulationOptions options)
    : dynamics_(dynamics), integrator_(integrator), options_(options), next_h_(options.time_step) {
  require(options.time_step >= 0.0 && options.end_time > 0.0, "end_time is positive, and time_step where it is given");
  state_.x = dynamics.system().initial_displacement;
  state_.v = dynamics.system().initial_velocity;
}

Step Simulation::propose() const {
  const double end = options_.end_time;
  if (integrator_.controller() != nullptr) {
    if (integrator_.lands_on_outputs()) {
      const double landing = std::min(next_landing(), end);
      return {landing - state_.t, landing, watched_};
    }
    if (state_.t + next_h_ >= end) return {end - state_.t, end, watched_};
    return {next_h_, state_.t + next_h_, watched_};
  }
  const double h = options_.time_step;
  const double t_end = static_cast<double>(accepted_ + 1) * h;
  if (t_end < end - kDivides * h) return {h, t_end};
  const bool divides = t_end <= end + kDivides * h;
  return {divides ? h : end - state_.t, end};
}

double Simulation::next_landing() const {
  double next = std::numeric_limits<double>::infinity();
  for (const Observer* observer : observers_) next = std::min(next, observer->next_instant(state_.t));
  return next;
}

void Simulation::add(Observer& observer) {
  require(report_.steps == 0, "observers are added before the first step");
  observers_.push_back(&observer);
  watched_ = watched_ || observer.watches_every_step();
  if (started_) observer.start(state_);
}

void Simulation::start() {
  if (started_) return;
  started_ = true;
  integrator_.start(state_);
  if (next_h_ == 0.0) next_h_ = integrator_.first_step(state_);
  require(next_h_ > 0.0, "a method without a first step of its own has a time_step");
  for (Observer* observer : observers_) observer->start(state_);
  if (!state_.a.allFinite())
    fail({next_h_, 0.0}, "the initial acceleration is not finite; check loads, masses and initial values");
}

bool Simulation::advance() {
  start();
  if (over_) return false;
  const StepController* controller = integrator_.controller();
  for (int rejections = 0; rejections <= kMostRejections; ++rejections) {
    const Step step = propose();
    const StepReport result = integrator_.step(state_, step, next_);
    report_.newton_iterations += result.newton_iterations;
    report_.rejected += result.inner_rejected;
    if (result.kept_failure || result.status == StepStatus::newton_failed) ++report_.newton_failures;

    if (controller == nullptr) {
      if (result.status != StepStatus::ok) {
        fail(step, diagnosis(result));
        return false;
      }
      accept(step, result);
      return !over_;
    }
    StepDecision decision{false, 0.5 * step.h};
    if (result.status == StepStatus::ok) decision = controller->decide(step.h, result);
    next_h_ = std::min(decision.next_h, options_.end_time);
    if (decision.accept) {
      accept(step, result);
      return !over_;
    }
    ++report_.rejected;
    if (!(next_h_ > kSmallestStep * options_.end_time)) {
      fail(step, "the step fell below its floor of " + to_short_text(kSmallestStep * options_.end_time) +
                     " s: " + diagnosis(result));
      return false;
    }
  }
  fail(propose(), "one step was rejected " + std::to_string(kMostRejections) +
                      " times; loosen the tolerance or widen the control's factors");
  return false;
}

void Simulation::accept(const Step& step, const StepReport& result) {
  ++accepted_;
  report_.steps += result.inner_steps;
  report_.t_end = next_.t;
  const double h = (next_.t < step.t_end ? next_.t - state_.t : step.h) / result.inner_steps;
  for (Observer* observer : observers_) observer->step({state_, next_, h, integrator_});
  std::swap(state_, next_);
  if (state_.t < options_.end_time) return;
  over_ = true;
  report_.completed = true;
}

void Simulation::fail(const Step& step, const std::string& reason) {
  over_ = true;
  report_.completed = false;
  report_.message = "t = " + to_short_text(state_.t) + " s, step " + std::to_string(report_.steps + 1) +
                    ", h = " + to_short_text(step.h) + " s: " + reason;
}

std::string Simulation::diagnosis(const StepReport& report) const {
  switch (report.status) {
    case StepStatus::not_finite: {
      Index largest = 0;
      state_.v.cwiseAbs().maxCoeff(&largest);
      return "the solution is no longer finite; it moves fastest in " + dynamics_.dof_name(largest) +
             ". A step beyond the stability limit does this: try a smaller time_step or an implicit method";
    }
    case StepStatus::newton_failed:
      return "Newton's iteration did not meet its tolerances within " + std::to_string(report.newton_iterations) +
             " solves; use a smaller time_step, more max_iterations, looser tolerances, or on_newton_failure = "
             "\"keep\"";
    case StepStatus::singular:
      return "the effective matrix is not positive definite; check stiffnesses and masses, or use a smaller time_step";
    case StepStatus::ok:
      break;
  }
  return "the error measure " + to_short_text(report.error) + " stays above the tolerance";
}

const RunReport& Simulation::run() {
  return run({});
}

const RunReport& Simulation::run(const std::function<bool()>& goes_on) {
  const auto file_seconds = [this] {
    double sum = 0.0;
    for (const Observer* observer : observers_) sum += observer->file_seconds();
    return sum;
  };
  start();
  const double files_before = file_seconds();
  const auto begin = Clock::now();
  while (advance() && (!goes_on || goes_on())) {
  }
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
  report_.wall_seconds += std::max(0.0, elapsed - (file_seconds() - files_before));
  for (Observer* observer : observers_) observer->finish();
  return report_;
}

}  // namespace butee::time

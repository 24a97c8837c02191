#include "butee/time/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "butee/core/error.hpp"
#include "butee/core/subnormals.hpp"
#include "butee/core/text.hpp"
#include "butee/core/zeros.hpp"
#include "butee/dynamics/external_forces.hpp"
#include "butee/time/contact_events.hpp"

namespace butee::time {
namespace {

/// Tolerance, as a fraction of a step, within which steps of one length divide the time to end_time, or to another
/// instant at which a step has to end.
constexpr double kDivides = 1e-9;
/// An adaptive method fails if a rejected step is shorter than this fraction of end_time, or than kSmallestOfInstant
/// times the present instant, which such steps would hardly move. A force that jumps takes short steps at any instant.
constexpr double kSmallestStep = 1e-20, kSmallestOfInstant = 4.0 * std::numeric_limits<double>::epsilon();
/// A step that is longer than so many units in the last place of an instant may lose a part of one (on_grid()).
constexpr double kUnitsOfStep = 1024.0;
/// No sensible control rejects one step this often; reduction factors close to 1 need many
/// rejections.
constexpr int kMostRejections = 5000;

/// The number of steps between checks of an adaptive method; it has stalled if it would need more
/// than kMostSteps.
constexpr std::int64_t kStallLooks = 200000;
constexpr double kMostSteps = 1e12;

/// From this size on a structure may have parts that hardly move.
constexpr Index kLarge = 64;

using Clock = std::chrono::steady_clock;

MethodLimits narrowed(MethodLimits limits, const Integrator& integrator) {
  limits.stability = std::min(limits.stability, integrator.traits().stability_limit);
  return limits;
}

/// A step from t that is not longer than `h` and ends at an instant t + h without rounding, as the ones of the same
/// length after it do until `end`. The rounding of equal steps has one sign, and its sum would be a drift of t.
double on_grid(double t, double h, double end) {
  for (const double latest : {std::max(end, t + h), t + h}) {
    const double unit = std::nextafter(latest, std::numeric_limits<double>::infinity()) - latest;
    if (h > kUnitsOfStep * unit) return std::floor(h / unit) * unit;
  }
  return h;
}

}  // namespace

Simulation::Simulation(dynamics::Dynamics& dynamics, Integrator& integrator, SimulationOptions options)
    : dynamics_(dynamics),
      integrator_(integrator),
      traits_(integrator.traits()),
      controller_(integrator.controller()),
      options_{options.time_step, options.end_time, narrowed(options.limits, integrator)},
      contact_memory_(dynamics.system().initial_contact),
      growth_(dynamics, options_.limits, integrator),
      next_h_(options_.time_step) {
  require(options_.time_step >= 0.0 && options_.end_time > 0.0,
          "end_time is positive, and time_step where it is given");
  for (State* state : {&state_, &next_})
    for (Vector* vector : {&state->x, &state->v, &state->a}) make_room(*vector, dynamics.size());
  state_.t = report_.t_end = origin_ = stall_t_ = dynamics.system().initial_time;
  state_.x = dynamics.system().initial_displacement;
  state_.v = dynamics.system().initial_velocity;
  if (controller_ != nullptr && !traits_.handles_load_discontinuities)
    discontinuities_ = dynamics.load_discontinuities();
}

Step Simulation::propose() const {
  const double end = options_.end_time;
  if (controller_ != nullptr) {
    double landing = std::min(next_discontinuity(state_.t), end);
    if (traits_.lands_on_outputs) landing = std::min(landing, next_landing());
    if (state_.t + (1.0 + kDivides) * next_h_ >= landing) {
      // All stages of a step that ends at a jump of the loads belong before it.
      const double before = dynamics::just_before(landing);
      if (before > state_.t && landing == next_discontinuity(state_.t) && dynamics_.loads_jump(landing))
        landing = before;
      return {landing - state_.t, landing, watched_};
    }
    return {next_h_, state_.t + next_h_, watched_};
  }
  const double h = options_.time_step;
  const double t_end = origin_ + static_cast<double>(accepted_ + 1) * h;
  if (t_end < end - kDivides * h) return {h, t_end};
  const bool divides = t_end <= end + kDivides * h;
  return {divides ? h : end - state_.t, end};
}

double Simulation::next_discontinuity(double t) const {
  const auto next = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), t);
  return next == discontinuities_.end() ? std::numeric_limits<double>::infinity() : *next;
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

void Simulation::begin_with(ConstVectorRef x, ConstVectorRef v, ConstVectorRef contact_memory) {
  require(!started_, "a motion to begin with comes before the start");
  require(x.size() == state_.x.size() && v.size() == state_.v.size(), "a motion of this system's size");
  state_.x = x;
  state_.v = v;
  contact_memory_ = contact_memory;
}

void Simulation::start() {
  if (started_) return;
  started_ = true;
  integrator_.start(state_, contact_memory_);
  const double own = next_h_ == 0.0 || traits_.lands_on_outputs ? integrator_.first_step(state_) : 0.0;
  if (next_h_ == 0.0 || std::isinf(own)) next_h_ = own;
  for (Observer* observer : observers_) observer->start(state_);
  growth_.start(state_);
  if (!state_.a.allFinite())
    fail({next_h_, 0.0}, describe_start(dynamics_, state_));
  else if (!(next_h_ > 0.0))
    fail({next_h_, 0.0},
         "the method found no first step; give time_step, and check the masses and stiffnesses, in SI units");
}

void Simulation::set_end_time(double end_time) {
  require(end_time >= state_.t && end_time > 0.0, "a run ends after the present instant");
  require(!over_ || report_.completed, "a run that has failed does not go on");
  options_.end_time = end_time;
  over_ = started_ && state_.t >= end_time;
  report_.completed = over_;
  origin_ = state_.t;
  accepted_ = 0;
}

void Simulation::set_motion(ConstVectorRef x, ConstVectorRef v) {
  require(x.size() == state_.x.size() && v.size() == state_.v.size(), "a motion of this system's size");
  start();
  state_.x = x;
  state_.v = v;
  start_anew();
}

void Simulation::loads_changed(bool jump) {
  start();
  dynamics_.loads_changed();
  if (jump || !report_.message.empty()) {
    start_anew();
  } else {
    integrator_.pass_discontinuity(state_, false);
    growth_.start(state_);
  }
}

void Simulation::start_anew() {
  const Vector memory = contact_memory(dynamics_, state_);
  integrator_.start(state_, memory);
  growth_.start(state_);
  const bool is_finite = state_.a.allFinite();
  if (!report_.message.empty()) {
    report_.message.clear();
    over_ = report_.completed = state_.t >= options_.end_time;
    origin_ = stall_t_ = state_.t;
    accepted_ = 0;
    // The steps before the failure give no information about those after it.
    const double first = options_.time_step > 0.0 || !is_finite ? options_.time_step : integrator_.first_step(state_);
    if (first > 0.0) next_h_ = first;
  }
  if (!is_finite) fail({next_h_, state_.t}, describe_start(dynamics_, state_));
}

bool Simulation::advance() {
  start();
  if (over_) return false;
  std::optional<FlushedSubnormals> flushed;
  if (state_.x.size() > kLarge) flushed.emplace();
  for (int rejections = 0; rejections <= kMostRejections; ++rejections) {
    if (controller_ != nullptr) next_h_ = on_grid(state_.t, next_h_, options_.end_time);
    Step step = propose();
    if (rejections == 0) integrator_.settle(state_, step.h);
    if (const double longest = controller_ != nullptr ? std::min(longest_, integrator_.longest_step(state_)) : step.h;
        step.h > longest)
      step = {longest, state_.t + longest, step.single};
    if (!(step.t_end > state_.t)) {
      fail(step, "the step is below the rounding of t; it moves fastest in " + fastest_dof(dynamics_, state_) +
                     ", where the scene is too stiff or a contact law too steep for this method");
      return false;
    }
    StepReport result;
    try {
      result = integrator_.step(state_, step, next_);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const LogicError&) {
      throw;
    } catch (const std::exception& error) {
      fail(step, error.what());
      return false;
    } catch (...) {
      fail(step, "the method threw an exception that is not a std::exception");
      return false;
    }
    report_.newton_iterations += result.newton_iterations;
    report_.rejected += result.inner_rejected;
    if (result.kept_failure || result.status == StepStatus::newton_failed) ++report_.newton_failures;

    if (controller_ == nullptr) {
      if (result.status != StepStatus::ok) {
        fail(step, describe_failure(dynamics_, options_.limits, state_, step, result));
        return false;
      }
      accept(step, result);
      return !over_;
    }
    StepDecision decision{false, 0.5 * step.h};
    if (result.status == StepStatus::ok) decision = controller_->decide(step.h, result);
    // A step shortened by a discontinuity of the loads gives no reason to reduce the desired
    // length.
    const double wanted = decision.accept && step.h < next_h_ ? next_h_ : 0.0;
    next_h_ = std::min(std::max(decision.next_h, wanted), options_.end_time);
    if (decision.accept) {
      accept(step, result);
      return !over_;
    }
    ++report_.rejected;
    const double floor = std::max(kSmallestStep * options_.end_time, kSmallestOfInstant * state_.t);
    if (!(next_h_ > floor)) {
      fail(step, "the step fell below its floor of " + to_short_text(floor) +
                     " s: " + describe_failure(dynamics_, options_.limits, state_, step, result));
      return false;
    }
  }
  fail(propose(), "one step was rejected " + std::to_string(kMostRejections) +
                      " times; loosen the tolerance or widen the control's factors");
  return false;
}

void Simulation::accept(const Step& step, const StepReport& result) {
  if (const double next = next_discontinuity(next_.t);
      next_.t >= dynamics::just_before(next) && dynamics_.loads_jump(next))
    next_.t = next;
  const double h = (next_.t < step.t_end ? next_.t - state_.t : step.h) / result.inner_steps;
  const AcceptedStep accepted{state_, next_, h, integrator_.dense_output(state_, next_),
                              traits_.event_precision * (next_.t - state_.t)};
  const double before = std::exchange(report_.t_end, next_.t);
  ++accepted_;
  report_.steps += result.inner_steps;
  is_observed_ = true;
  try {
    for (Observer* observer : observers_) observer->step(accepted);
  } catch (...) {  // the step is taken again
    is_observed_ = false;
    report_.t_end = before;
    --accepted_;
    report_.steps -= result.inner_steps;
    throw;
  }
  is_observed_ = false;
  std::swap(state_, next_);
  if (std::binary_search(discontinuities_.begin(), discontinuities_.end(), state_.t))
    integrator_.pass_discontinuity(state_, dynamics_.loads_jump(state_.t));
  const bool is_last = !(state_.t < options_.end_time);
  if (growth_.step(next_, state_, h, is_last)) {
    fail({h, state_.t}, growth_.describe(state_, h));
    return;
  }
  if (accepted_ % kStallLooks == 0 && !is_last && has_stalled()) {
    fail({h, state_.t}, "the last " + std::to_string(kStallLooks) + " steps went over " +
                            to_short_text(state_.t - stall_t_) +
                            " s, too little to reach the end; it moves fastest in " + fastest_dof(dynamics_, state_) +
                            ". Loosen the tolerance, or take another method");
    return;
  }
  if (!is_last) return;
  over_ = true;
  report_.completed = true;
  report_.warnings = growth_.warnings();
}

bool Simulation::has_stalled() {
  if (controller_ == nullptr) return false;
  const double progress = state_.t - stall_t_,
               least = options_.end_time * static_cast<double>(kStallLooks) / kMostSteps;
  if (progress >= 0.0 && progress < least) return true;
  stall_t_ = state_.t;
  return false;
}

void Simulation::fail(const Step& step, const std::string& reason) {
  over_ = true;
  report_.completed = false;
  report_.message = "t = " + to_short_text(state_.t) + " s, step " + std::to_string(report_.steps + 1) +
                    ", h = " + to_short_text(step.h) + " s: " + reason;
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

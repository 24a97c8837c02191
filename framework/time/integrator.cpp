#include "butee/time/integrator.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/time/contact_events.hpp"
#include "butee/time/departure.hpp"

namespace butee::time {
namespace {

/// A finite sum has finite terms; the terms are checked one by one only if it is not finite.
bool is_finite(const State& state) {
  if (state.x.size() == 1) return std::isfinite(state.x[0]) && std::isfinite(state.v[0]) && std::isfinite(state.a[0]);
  if (std::isfinite(state.x.sum() + state.v.sum() + state.a.sum())) return true;
  return state.x.allFinite() && state.v.allFinite() && state.a.allFinite();
}

}  // namespace

Integrator::Integrator(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}

void Integrator::start(State& state) {
  start(state, Vector());
}

void Integrator::start(State& state, ConstVectorRef contact_memory) {
  require(state.x.size() == dynamics_.size() && state.v.size() == dynamics_.size(), "a state of another size");
  state.a.resize(state.x.size());
  complete(state, contact_memory);
  if (!traits().starts_as_published && leave_middle(dynamics_, state)) complete(state, contact_memory);
  do_start(state);
}

void Integrator::complete(State& state, ConstVectorRef contact_memory) {
  if (dynamics_.obstacles() != nullptr && traits().follows_contact_phases) {
    if (!events_) events_ = std::make_unique<ContactEvents>(dynamics_, traits().velocity_uncertainty);
    events_->start(state, contact_memory);
  } else {
    if (dynamics_.obstacles() != nullptr) dynamics_.obstacles()->follow_live();
    dynamics_.acceleration(state.t, state.x, state.v, state.a);
  }
}

void Integrator::pass_discontinuity(State& state, bool jumps) {
  if (traits().starts_as_published && !jumps) return;
  if (events_) events_->follow(state);
  const bool leaves = !traits().starts_as_published && leave_middle(dynamics_, state);
  if (!leaves && !jumps) return;
  Vector jump = -state.a;
  dynamics_.acceleration(state.t, state.x, state.v, state.a);
  jump += state.a;
  do_jump(state, jump);
}

void Integrator::go_back(const State& state) {
  if (events_) events_->follow(state);
}

void Integrator::settle(State& state, double h) {
  if (events_) events_->settle(state, h, traits().event_precision);
}

double Integrator::longest_step(const State& state) {
  return events_ ? events_->longest_step(state) : std::numeric_limits<double>::infinity();
}

StepReport Integrator::step(const State& from, const Step& step, State& to) {
  require(step.h > 0.0 && &from != &to, "a step of positive length into another state");
  require(from.a.size() == from.x.size(), "start() comes before step()");
  to.x.resize(from.x.size());
  to.v.resize(from.v.size());
  to.a.resize(from.a.size());
  to.memory.resize(from.memory.size());
#ifndef NDEBUG
  // Tests then find a method that reads what it has not written.
  for (Vector* unset : {&to.x, &to.v, &to.a, &to.memory}) unset->setConstant(std::numeric_limits<double>::quiet_NaN());
#endif
  to.t = step.t_end;
  if (events_) {
    to.contact = from.contact;
    events_->follow(from);
  }
  StepReport report = do_step(from, step, to);
  for (const Vector* vector : {&to.x, &to.v, &to.a})
    require(vector->size() == from.x.size(), "a step leaves the sizes of x, v and a as they are");
  if (events_ && report.status == StepStatus::ok && is_finite(to)) end_at_event(from, step, to, report);
  require(to.t > from.t && to.t <= step.t_end, "a step ends where it was to end, or earlier");
  if (report.status == StepStatus::ok && !is_finite(to)) report.status = StepStatus::not_finite;
  return report;
}

void Integrator::end_at_event(const State& from, const Step& step, State& to, StepReport& report) {
  constexpr int kMostTrials = 6, kMostCorrections = 3, kMostRefuted = 3;
  // As parts of the step that ends at a change (chosen): kNear, the largest error of the dense output there; kFar, a
  // correction beyond which the linear estimate of the miss is of no use.
  constexpr double kLeast = 1e-10, kSame = 1e-6, kSpacings = 4.0, kNear = 1e-2, kFar = 0.1;
  // Tolerances refer to the length that was asked for: changes of two contacts almost at the same instant leave a step
  // too short to be a measure.
  const double spacing = std::nextafter(from.t, std::numeric_limits<double>::infinity()) - from.t,
               earliest = from.t + std::max(kLeast * step.h, kSpacings * spacing),
               good = std::max(traits().event_precision * step.h, kSpacings * spacing);
  const auto is_accepted = [&] { return controller() == nullptr || controller()->decide(step.h, report).accept; };
  const double wanted = report.proposal;
  const auto redo = [&](double t_end) {
    to.t = t_end;
    StepReport next = do_step(from, {t_end - from.t, t_end, step.single, true}, to);
    ++next.inner_rejected;
    next.inner_rejected += report.inner_rejected;
    next.newton_iterations += report.newton_iterations;
    report = next;
    if (!is_accepted()) return false;
    report.proposal = std::max(report.proposal, wanted);
    return report.status == StepStatus::ok && is_finite(to);
  };
  int refuted = 0;
  for (int trial = 0; trial < kMostTrials && is_accepted(); ++trial) {
    auto event = events_->search().first(dense_output(from, to));
    if (!event) return;
    double end = std::min(std::max(event->t, earliest), to.t);
    if (!redo(end)) return;
    bool is_at_end = false;
    for (int k = 0; k < kMostCorrections && to.t == end && is_accepted(); ++k) {
      const auto [miss, falls] = events_->search().miss(*event, to.t - from.t, to);
      is_at_end = falls && std::abs(miss) <= good;
      if (is_at_end || std::abs(miss) <= good || std::abs(miss) > kFar * (to.t - from.t)) break;
      const double t_end = to.t - miss;
      if (!(t_end >= earliest && t_end <= step.t_end) || t_end == to.t) break;
      end = t_end;
      if (!redo(end)) return;
    }
    // A method may end a step even earlier, for reasons of its own; the change is then sought anew.
    if (to.t != end) continue;
    events_->mark(*event, to);
    // Another change may come earlier; the end of the step is then not this event. In the dense output this one itself
    // may lie before the end by its error; the state at the end is more accurate.
    const auto before = events_->search().first(dense_output(from, to));
    const bool is_same = before && before->contact == event->contact && before->which == event->which;
    const double tolerated =
        !is_same ? good : std::max({kSame * step.h, good, is_at_end ? kNear * (to.t - from.t) : 0.0});
    if (!before || to.t - before->t <= tolerated) return;
    // If the step that ends at the located change does not reach it, three times in turn (chosen), the switching
    // function only approaches 0, and falls below it by errors of the dense output: there is no change.
    if (is_same && !events_->search().is_over(*event, to) && ++refuted == kMostRefuted) {
      to.contact = from.contact;
      redo(step.t_end);
      return;
    }
    to.contact = from.contact;
  }
}

Integrator::~Integrator() = default;

void Integrator::do_start(State&) {}

void Integrator::do_jump(State&, ConstVectorRef) {}

}  // namespace butee::time

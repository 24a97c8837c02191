#include "integrators/exact.hpp"

#include <algorithm>
#include <cmath>

#include "butee/config/diagnostics.hpp"
#include "integrators/fastest_rates.hpp"
#include "integrators/methods.hpp"

namespace butee::integrators {

using time::State;
using time::StepReport;
using time::StepStatus;

namespace {

constexpr const char* kSeriesTolerance = "series_tolerance";
/// The parameter of other methods, accepted so that the same scene runs with all methods.
constexpr const char* kTolerance = "tolerance";

/// 1/omega of the stiffest DOF with its stops closed, s; 1 s where nothing has a stiffness.
double natural_time(dynamics::Dynamics& dynamics) {
  const double rate = fastest_rates(dynamics).closed;
  return rate > 0.0 ? 1.0 / rate : 1.0;
}

}  // namespace

time::StepDecision Exact::Controller::decide(double, const StepReport& report) const {
  return {true, report.error};
}

Exact::Exact(dynamics::Dynamics& dynamics, int order, double series_tolerance)
    : Integrator(dynamics), path_(dynamics, order, series_tolerance), first_length_(natural_time(dynamics)) {}

void Exact::do_start(State& state) {
  first_step_ = path_.first_length(state, first_length_);
}

StepReport Exact::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report;
  report.status = path_.follow(from, step);
  if (report.status != StepStatus::ok) return report;
  const TaylorExpansion& last = path_.last();
  for (Index i = 0; i < to.x.size(); ++i) {
    to.x[i] = last.value(i, last.end);
    to.v[i] = last.velocity(i, last.end);
    to.a[i] = last.acceleration(i, last.end);
  }
  to.t = path_.end();
  report.error = last.reach * last.length;
  return report;
}

time::IntegratorType exact_type() {
  return {
      .name = "exact",
      .aliases = {"taylor"},
      .summary = "Taylor series with every change of contact located; no truncation error above rounding",
      .parameters = {config::integer("order", "the order of the series")
                         .at_least(4)
                         .at_most(60)
                         .or_else(std::int64_t{Exact::kOrder}),
                     config::number(kSeriesTolerance, "1", "size of the last terms of a series relative to the largest")
                         .above(0)
                         .at_most(0.1)
                         .or_else(Exact::kSeriesTolerance)
                         .sweep(1e-4, Exact::kSeriesTolerance),
                     config::number(kTolerance, "1", "ignored: truncation stays below rounding").above(0).optional()},
      .finds_first_step = true,
      .contacts = time::ContactSupport::all,
      .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        return std::make_unique<Exact>(dynamics, static_cast<int>(p.integer("order")), p.number(kSeriesTolerance));
      },
      .check =
          [](const config::Parameters& p, config::Diagnostics& diagnostics) {
            if (p.has(kTolerance))
              diagnostics.warning(
                  p.key(kTolerance), p.value(kTolerance).at,
                  "is ignored by exact, whose truncation stays below rounding; its own key is series_tolerance");
          }};
}

}  // namespace butee::integrators

#include "integrators/step_doubling.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/methods.hpp"

namespace butee::integrators {

using config::number;
using config::Parameters;
using time::IntegratorType;

time::StepDecision FixedFactors::decide(double h, const time::StepReport& report) const {
  if (report.error <= tolerance_ / 100.0) return {true, grow_ * h};
  if (report.error <= tolerance_) return {true, h};
  return {false, h / shrink_};
}

time::StepDecision ErrorScaled::decide(double h, const time::StepReport& report) const {
  const bool accept = report.error <= tolerance_;
  return {accept, safety_ * h * std::pow(tolerance_ / report.error, accept ? 0.2 : 0.25)};
}

time::StepReport StepDoublingRungeKutta4::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h, t_half = from.t + 0.5 * h;
  for (Vector* vector : {&whole_x_, &whole_v_, &half_x_, &half_v_, &half_a_}) vector->resize(from.x.size());

  kernel_.advance(from.t, h, step.t_end, from.x, from.v, from.a, whole_x_, whole_v_);
  kernel_.advance(from.t, 0.5 * h, t_half, from.x, from.v, from.a, half_x_, half_v_);
  dynamics().acceleration(t_half, half_x_, half_v_, half_a_);
  kernel_.advance(t_half, 0.5 * h, step.t_end, half_x_, half_v_, half_a_, to.x, to.v);

  time::StepReport report;
  const double dx = (whole_x_ - to.x).lpNorm<Eigen::Infinity>(), dv = (whole_v_ - to.v).lpNorm<Eigen::Infinity>();
  report.error = std::max(dx, dv) / 15.0;
  if (!std::isfinite(dx) || !std::isfinite(dv) || !to.x.allFinite() || !to.v.allFinite()) {
    report.status = time::StepStatus::not_finite;
  } else if (controller_->decide(h, report).accept) {
    dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  } else {
    to.a = from.a;  // A step that will be repeated needs no evaluation at its end.
  }
  return report;
}

namespace {

// The stability limits are those of the two half steps, whose result is kept.

config::Parameter tolerance() {
  return number("tolerance", "m, rad, m/s, rad/s", "eps0, the largest difference of a step against two halves, over 15")
      .above(0)
      .sweep(1e-1, 1e-10);
}

}  // namespace

IntegratorType rk4_fixed_factors_type() {
  return {.name = "rk4_fixed_factors",
          .aliases = {"RK4-2"},
          .summary = "Runge-Kutta 4 with step doubling, the step changed by constant factors",
          .parameters = {tolerance(),
                         number("shrink", "1", "a, by which a rejected step is divided").above(1).try_first(1.1),
                         number("grow", "1",
                                "b, by which the step is multiplied if the error is below a hundredth of the tolerance")
                             .at_least(1)
                             .try_first(2.0)},
          .order = 4.0,
          .stability_limit = 2.0 * kRungeKutta4Limit,
          .damping_limit = 2.0 * kRungeKutta4DampingLimit,
          .contacts = time::ContactSupport::without_memory,
          .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<StepDoublingRungeKutta4>(
                dynamics, std::make_unique<FixedFactors>(p.number("tolerance"), p.number("shrink"), p.number("grow")));
          }};
}

IntegratorType rk4_error_scaled_type() {
  return {
      .name = "rk4_error_scaled",
      .aliases = {"RK4-3"},
      .summary = "Runge-Kutta 4 with step doubling, the step changed by the error",
      .parameters = {tolerance(),
                     number("safety", "1", "s, the safety factor on the new step").above(0).at_most(1).try_first(0.9)},
      .order = 4.0,
      .stability_limit = 2.0 * kRungeKutta4Limit,
      .damping_limit = 2.0 * kRungeKutta4DampingLimit,
      .contacts = time::ContactSupport::without_memory,
      .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        return std::make_unique<StepDoublingRungeKutta4>(
            dynamics, std::make_unique<ErrorScaled>(p.number("tolerance"), p.number("safety")));
      }};
}

}  // namespace butee::integrators

#include "integrators/generalized_alpha.hpp"

#include <algorithm>

#include "integrators/methods.hpp"

namespace butee::integrators {

using config::number;
using config::Parameter;
using config::Parameters;
using time::State;
using time::StepReport;

/// LocalErrorControl::Orders::contact_change
constexpr double kContactChange = 25.0;
/// The fraction of a step over which the rate of the acceleration is computed by a difference.
constexpr double kPart = 0.05;

AlphaParameters AlphaParameters::of_radius(double rho_inf) {
  const double alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0), alpha_f = rho_inf / (rho_inf + 1.0);
  const double excess = 1.0 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * excess * excess, excess - 0.5};
}

AlphaParameters AlphaParameters::hht(double alpha) {
  return {0.0, alpha, 0.25 * (1.0 + alpha) * (1.0 + alpha), 0.5 + alpha};
}

double AlphaParameters::kink() const {
  // If a force (s - a)_+ begins at a = 1 - u, the step gains the speed c (u - alpha_f)_+ instead of u^2/2. The
  // difference is largest at u = alpha_f or at u = c <= 1.
  const double c = gamma / (1.0 - alpha_m);
  return std::max(c * (0.5 * c - alpha_f), 0.5 * alpha_f * alpha_f);
}

GeneralizedAlpha::GeneralizedAlpha(dynamics::Dynamics& dynamics, AlphaParameters parameters,
                                   const std::optional<Goal>& goal)
    : Integrator(dynamics), parameters_(parameters), stage_(dynamics, kNewton) {
  if (!goal) return;
  control_.emplace(dynamics, *goal, parameters.kink(), kContactChange);
  discontinuities_ = dynamics.load_discontinuities();
  contact_.emplace(dynamics, goal->tolerance);
}

void GeneralizedAlpha::do_start(State& state) {
  if (control_) control_->start(state);
}

void GeneralizedAlpha::take_acceleration(const State& from, double h) {
  old_a_ = from.a;
  if (!control_) return;
  const double last = AccelerationError::last_step(from);
  if (last > 0.0 && last != h)
    old_a_ = AccelerationError::extrapolated(from, (parameters_.alpha_m - parameters_.alpha_f) * h);
}

void GeneralizedAlpha::take_slope(const time::Step& step, State& to) {
  const auto jump = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), step.t_end);
  const double d = kPart * (jump == discontinuities_.end() ? step.h : std::min(step.h, *jump - step.t_end));
  x_ = to.x + d * to.v;
  v_ = to.v + d * to.a;
  dynamics().acceleration(step.t_end + d, x_, v_, a_);
  a_ = (a_ - to.a) / d;
  AccelerationError::take_slope(to, a_);
}

StepReport GeneralizedAlpha::do_step(const State& from, const time::Step& step, State& to) {
  const auto [alpha_m, alpha_f, beta, gamma] = parameters_;
  const double h = step.h, on_m = 1.0 - alpha_m, on_f = 1.0 - alpha_f;
  take_acceleration(from, h);
  // Initial guess a_{n+1} = a_n.
  to.x = from.x + h * from.v + 0.5 * h * h * old_a_;
  to.v = from.v + h * old_a_;
  x_ = on_f * to.x + alpha_f * from.x;
  v_ = on_f * to.v + alpha_f * from.v;
  a_ = old_a_;
  const double t = step.t_end - alpha_f * h, velocity_factor = on_f * gamma * h / on_m,
               displacement_factor = on_f * beta * h * h / on_m;
  StepReport report = stage_.solve(t, velocity_factor, displacement_factor, x_, v_, a_);
  if (report.status != time::StepStatus::ok) return report;
  to.a = (a_ - alpha_m * old_a_) / on_m;
  to.x += beta * h * h * (to.a - old_a_);
  to.v += gamma * h * (to.a - old_a_);
  if (!control_) return report;
  const bool load_jumps = std::binary_search(discontinuities_.begin(), discontinuities_.end(), step.t_end);
  v_ = LocalErrorControl::scales_v(from).cwiseMax(to.v.cwiseAbs());
  if (!load_jumps && !contact_->changed(from, to, h, v_)) {
    control_->judge(from, to, h, a_, alpha_f * h, report);
    return report;
  }
  dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  control_->judge(from, to, h, report);
  control_->forget_slope(to);
  if (load_jumps && report.error <= 1.0) take_slope(step, to);
  return report;
}

namespace {

time::IntegratorType type_of(std::string name, std::string alias, std::string summary, Parameter dissipation,
                             std::function<AlphaParameters(const Parameters&)> read, bool is_adaptive) {
  std::vector<Parameter> parameters = {std::move(dissipation)};
  if (is_adaptive) parameters.push_back(LocalErrorControl::parameter(1e-4, LocalErrorControl::kSecondOrder));
  return {.name = std::move(name),
          .aliases = {std::move(alias)},
          .summary = std::move(summary),
          .parameters = std::move(parameters),
          .order = 2.0,
          .fixed_step = !is_adaptive,
          .finds_first_step = is_adaptive,
          .make = [read, is_adaptive](const Parameters& p,
                                      dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<GeneralizedAlpha>(dynamics, read(p), Goal::read_if(is_adaptive, p));
          }};
}

time::IntegratorType chung_hulbert(bool is_adaptive) {
  return type_of(
      is_adaptive ? "generalized_alpha_adaptive" : "generalized_alpha", is_adaptive ? "GA2" : "GA1",
      is_adaptive ? "generalized-alpha, steps by the local error" : "generalized-alpha, fixed steps",
      number("rho_inf", "1", "the spectral radius at infinite frequency; 1: no numerical damping")
          .at_least(0)
          .at_most(1)
          .or_else(0.8),
      [](const Parameters& p) { return AlphaParameters::of_radius(p.number("rho_inf")); }, is_adaptive);
}

time::IntegratorType hilber_hughes_taylor(bool is_adaptive) {
  return type_of(
      is_adaptive ? "hht_alpha_adaptive" : "hht_alpha", is_adaptive ? "HHT2" : "HHT1",
      is_adaptive ? "HHT-alpha, steps by the local error" : "HHT-alpha, fixed steps",
      number("alpha", "1", "numerical damping, in absolute value; 0: Newmark's")
          .at_least(0)
          .at_most(1.0 / 3.0)
          .or_else(0.05),
      [](const Parameters& p) { return AlphaParameters::hht(p.number("alpha")); }, is_adaptive);
}

}  // namespace

time::IntegratorType generalized_alpha_type() {
  return chung_hulbert(false);
}
time::IntegratorType generalized_alpha_adaptive_type() {
  return chung_hulbert(true);
}
time::IntegratorType hht_alpha_type() {
  return hilber_hughes_taylor(false);
}
time::IntegratorType hht_alpha_adaptive_type() {
  return hilber_hughes_taylor(true);
}

}  // namespace butee::integrators

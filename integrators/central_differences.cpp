#include "integrators/central_differences.hpp"

#include "integrators/methods.hpp"

namespace butee::integrators {

/// Measured in tests/conformance/error_constant_test.cpp.
constexpr double kKink = 0.125, kContactChange = 10.0;
/// The largest h omega and h c/m.
constexpr double kStableTurn = 2.0, kStableDecay = 1.0;

CentralDifferences::CentralDifferences(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal)
    : Integrator(dynamics) {
  if (goal) control_.emplace(dynamics, *goal, kKink, kContactChange, kStableTurn, kStableDecay);
}

void CentralDifferences::do_start(time::State& state) {
  if (control_) control_->start(state);
}

time::StepReport CentralDifferences::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h;
  to.v = from.v + 0.5 * h * from.a;
  to.x = from.x + h * to.v;
  guess_ = to.v + 0.5 * h * from.a;
  dynamics().acceleration(step.t_end, to.x, guess_, to.a);
  to.v += 0.5 * h * to.a;
  time::StepReport report;
  if (control_) control_->judge(from, to, h, report);
  return report;
}

namespace {

time::IntegratorType type_of(bool is_adaptive) {
  std::vector<config::Parameter> parameters;
  if (is_adaptive) parameters.push_back(LocalErrorControl::parameter(1e-3, LocalErrorControl::kSecondOrder));
  return {.name = is_adaptive ? "central_differences_adaptive" : "central_differences",
          .aliases = {is_adaptive ? "CD2" : "CD1"},
          .summary = is_adaptive ? "central differences, explicit, steps by the local error"
                                 : "central differences, explicit, fixed steps",
          .parameters = std::move(parameters),
          .order = 2.0,
          .stability_limit = kStableTurn,
          .damping_limit = kStableDecay,
          .fixed_step = !is_adaptive,
          .finds_first_step = is_adaptive,
          .make = [is_adaptive](const config::Parameters& p,
                                dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<CentralDifferences>(dynamics, Goal::read_if(is_adaptive, p));
          }};
}

}  // namespace

time::IntegratorType central_differences_type() {
  return type_of(false);
}
time::IntegratorType central_differences_adaptive_type() {
  return type_of(true);
}

}  // namespace butee::integrators

#include "integrators/bathe.hpp"

#include <numbers>

#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

constexpr double kGamma = 2.0 - std::numbers::sqrt2;
/// y_{n+1} = kMiddle y_gamma + kOld y_n + kStage h y'_{n+1}
constexpr double kMiddle = 1.0 / (kGamma * (2.0 - kGamma));
constexpr double kOld = 1.0 - kMiddle;
constexpr double kStage = 0.5 * kGamma;
constexpr double kConstant = 1.0, kContactChange = 25.0, kKink = 0.0625;
/// Weights of h y' at the three points in the difference from the embedded formula of order 3.
constexpr double kWeight = std::numbers::sqrt2 / 4.0;
constexpr double kError0 = (4.0 * kWeight - 1.0) / 3.0, kError1 = -1.0 / 3.0, kError2 = 2.0 * kStage / 3.0;

}  // namespace

Bathe::Bathe(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal)
    : Integrator(dynamics), stage_(dynamics, kNewton) {
  if (goal)
    control_.emplace(dynamics, *goal, LocalErrorControl::Orders{3.0, 2.0, kConstant, kContactChange, kKink},
                     LocalErrorControl::Steps::geometric);
}

void Bathe::do_start(time::State& state) {
  if (!control_) return;
  state.memory.resize(LocalErrorControl::memory_size(state.x.size()));
  control_->start(state);
}

time::StepReport Bathe::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h, d = kStage * h;
  a_ = from.a;
  v_ = from.v + 2.0 * d * from.a;
  x_ = from.x + d * (from.v + v_);
  time::StepReport report = stage_.solve(from.t + kGamma * h, d, d * d, x_, v_, a_);
  if (report.status != time::StepStatus::ok) return report;
  to.a = a_;
  to.v = kMiddle * v_ + kOld * from.v + d * to.a;
  to.x = kMiddle * x_ + kOld * from.x + d * to.v;
  const time::StepReport second = stage_.solve(step.t_end, d, d * d, to.x, to.v, to.a);
  report.newton_iterations += second.newton_iterations;
  report.status = second.status;
  if (!control_ || report.status != time::StepStatus::ok) return report;
  error_x_ = h * (kError0 * from.v + kError1 * v_ + kError2 * to.v);
  error_v_ = h * (kError0 * from.a + kError1 * a_ + kError2 * to.a);
  control_->judge(from, to, h, error_x_, error_v_, report);
  return report;
}

namespace {

time::IntegratorType type_of(bool is_adaptive) {
  std::vector<config::Parameter> parameters;
  if (is_adaptive) parameters.push_back(LocalErrorControl::parameter(1e-4, LocalErrorControl::kSecondOrder));
  return {.name = is_adaptive ? "bathe_adaptive" : "bathe",
          .aliases = {is_adaptive ? "BATHE2" : "BATHE1"},
          .summary = is_adaptive ? "composite trapezoid and backward differences, L-stable, steps by the local error"
                                 : "composite trapezoid and backward differences, L-stable, fixed steps",
          .parameters = std::move(parameters),
          .order = 2.0,
          .fixed_step = !is_adaptive,
          .finds_first_step = is_adaptive,
          .make = [is_adaptive](const config::Parameters& p,
                                dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Bathe>(dynamics, Goal::read_if(is_adaptive, p));
          }};
}

}  // namespace

time::IntegratorType bathe_type() {
  return type_of(false);
}
time::IntegratorType bathe_adaptive_type() {
  return type_of(true);
}

}  // namespace butee::integrators

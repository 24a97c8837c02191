#include "integrators/discrete_gradient.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

/// If two displacements are closer than this fraction of their size and the gap, the difference of
/// energies loses too many digits. The mean of both forces replaces the quotient; its error is of
/// second order in the distance.
constexpr double kClose = 1e-6;
/// The quotient of energies is the mean of the force along a straight path, also if a stop closes on it.
constexpr double kKink = 0.0;
/// Rounding of the energy differences limits the residual to this fraction of all forces.
constexpr NewtonOptions kNewtonOfEnergies = {.residual_tolerance = 1e-9,
                                             .increment_tolerance = 1e-7,
                                             .max_iterations = 40,
                                             .checks_linear_too = false,
                                             .takes_guess = false,
                                             .checks_each_stop = true};

}  // namespace

void DiscreteGradientStage::begin(ConstVectorRef x) {
  dynamics::ElasticStops& contact = dynamics().stops();
  if (contact.size() == 0) return;
  for (Vector* vector : {&start_, &end_, &force_start_, &force_end_, &tangent_end_}) vector->resize(contact.size());
  contact.displacement(x, start_);
  contact.force(start_, force_start_);
}

void DiscreteGradientStage::contact(ConstVectorRef w, bool, VectorRef f, VectorRef k) {
  dynamics::ElasticStops& contact = dynamics().stops();
  end_ = 2.0 * w - start_;
  contact.tangent(end_, force_end_, tangent_end_);
  for (Index i = 0; i < end_.size(); ++i) {
    const double step = end_[i] - start_[i];
    if (std::abs(step) <= kClose * (std::abs(end_[i]) + std::abs(start_[i]) + contact.play_of(i).gap)) {
      f[i] = 0.5 * (force_start_[i] + force_end_[i]);
      k[i] = tangent_end_[i];
    } else {
      f[i] = -(contact.energy_of(i, end_[i]) - contact.energy_of(i, start_[i])) / step;
      k[i] = 2.0 * (f[i] - force_end_[i]) / step;
    }
    // A regularised law gives a negative tangent if a stop passes w = 0; Newton's iteration
    // converges as well without it.
    k[i] = std::max(k[i], 0.0);
  }
}

DiscreteGradient::DiscreteGradient(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal)
    : Integrator(dynamics), stage_(dynamics, kNewtonOfEnergies) {
  if (goal) control_.emplace(dynamics, *goal, kKink);
}

void DiscreteGradient::do_start(time::State& state) {
  if (control_) control_->start(state);
}

time::StepReport DiscreteGradient::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h, half = 0.5 * h;
  stage_.begin(from.x);
  a_ = from.a;
  v_ = from.v + half * a_;
  x_ = from.x + half * v_;
  time::StepReport report = stage_.solve(from.t + half, half, half * half, x_, v_, a_);
  if (report.status != time::StepStatus::ok) return report;
  to.x = 2.0 * x_ - from.x;
  to.v = 2.0 * v_ - from.v;
  dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  if (control_) control_->judge(from, to, h, report);
  return report;
}

namespace {

time::IntegratorType type_of(bool is_adaptive) {
  std::vector<config::Parameter> parameters;
  if (is_adaptive) parameters.push_back(LocalErrorControl::parameter(1e-4, LocalErrorControl::kSecondOrder));
  return {.name = is_adaptive ? "discrete_gradient_adaptive" : "discrete_gradient",
          .aliases = {is_adaptive ? "DG2" : "DG1"},
          .summary = is_adaptive ? "midpoint rule that cannot gain energy at a stop, steps by the local error"
                                 : "midpoint rule that cannot gain energy at a stop, fixed steps",
          .parameters = std::move(parameters),
          .order = 2.0,
          .fixed_step = !is_adaptive,
          .finds_first_step = is_adaptive,
          .make = [is_adaptive](const config::Parameters& p,
                                dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<DiscreteGradient>(dynamics, Goal::read_if(is_adaptive, p));
          }};
}

}  // namespace

time::IntegratorType discrete_gradient_type() {
  return type_of(false);
}
time::IntegratorType discrete_gradient_adaptive_type() {
  return type_of(true);
}

}  // namespace butee::integrators

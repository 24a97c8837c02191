#pragma once

#include <optional>

#include "integrators/acceleration_error.hpp"
#include "integrators/stage_solver.hpp"

namespace butee::integrators {

/// Parameters of the generalized-alpha family in Chung and Hulbert's convention, in which alpha
/// weights the old state.
struct AlphaParameters {
  double alpha_m, alpha_f, beta, gamma;

  /// generalized-alpha with spectral radius rho_inf, 0 to 1, at infinite frequency.
  static AlphaParameters of_radius(double rho_inf);
  /// HHT-alpha with 0 <= alpha <= 1/3, the absolute value.
  static AlphaParameters hht(double alpha);
  /// LocalErrorControl::Orders::kink.
  double kink() const;
};

/// generalized_alpha and hht_alpha, with a fixed step size or one controlled by the local error.
///
///     M a_(1-alpha_m) + C v_(1-alpha_f) + K x_(1-alpha_f) = F(t_(1-alpha_f)) + F_c(x_(1-alpha_f))
///
/// with y_(1-alpha) = (1 - alpha) y_{n+1} + alpha y_n and Newmark's x_{n+1} and v_{n+1}. Order 2 if
/// the algorithmic acceleration is carried from step to step and the load is taken at
/// t_(1-alpha_f); unconditionally stable for linear motion. One stage solve per step, contact by
/// Newton's method in stop space.
///
/// AccelerationError controls the step size by displacement and velocity, from the accelerations
/// that satisfy the balance above. These belong to an instant within the step, at which a stop that
/// closes later is still open. If a stop closed or opened, or if a load or its slope jumps, the
/// controlled variants therefore use the acceleration at the end of the step, both for the estimate
/// and for the next step. This costs one evaluation and one solve with M, and a second one for the
/// rate of the acceleration at jumps of loads. The algorithmic a_n is the acceleration at t_n +
/// (alpha_m - alpha_f) h, as the expansion of the balance in h shows. If h changes, a_n is
/// recomputed from the balanced accelerations; otherwise every change of the step size would lose
/// an order. Orders are checked in tests/conformance.
class GeneralizedAlpha final : public time::Integrator {
 public:
  /// Without a goal the step size is fixed.
  GeneralizedAlpha(dynamics::Dynamics& dynamics, AlphaParameters parameters, const std::optional<Goal>& goal);

  const time::StepController* controller() const override { return control_ ? &control_->controller() : nullptr; }
  double first_step(const time::State&) const override { return control_ ? control_->first_step() : 0.0; }

 private:
  void do_start(time::State& state) override;
  void do_jump(time::State& state, ConstVectorRef jump) override {
    if (control_) AccelerationError::add_jump(state, jump);
  }
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  /// Fills old_a_ with a_n for a step of length h.
  void take_acceleration(const time::State& from, double h);
  /// Computes the rate of the acceleration at a state at which a load or its slope jumps, by one
  /// more evaluation.
  void take_slope(const time::Step& step, time::State& to);

  AlphaParameters parameters_;
  StageSolver stage_;
  std::optional<AccelerationError> control_;
  std::optional<ContactOnTheWay> contact_;
  std::vector<double> discontinuities_;  ///< instants at which a load or its slope jumps, s
  Vector x_, v_, a_, old_a_;
};

}  // namespace butee::integrators

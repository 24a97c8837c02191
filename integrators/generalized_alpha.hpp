#pragma once

#include <optional>

#include "integrators/acceleration_error.hpp"
#include "integrators/stage_solver.hpp"

namespace butee::integrators {

/// The parameters of the generalized-alpha family in Chung and Hulbert's convention, where alpha weighs the old state.
struct AlphaParameters {
  double alpha_m, alpha_f, beta, gamma;

  /// generalized-alpha: spectral radius rho_inf, 0 to 1, at infinite frequency.
  static AlphaParameters of_radius(double rho_inf);
  /// HHT-alpha: 0 <= alpha <= 1/3, in absolute value.
  static AlphaParameters hht(double alpha);
};

/// generalized_alpha and hht_alpha, with fixed steps or steps by the local error.
///
///     M a_(1-alpha_m) + C v_(1-alpha_f) + K x_(1-alpha_f) = F(t_(1-alpha_f)) + F_c(x_(1-alpha_f))
///
/// where y_(1-alpha) = (1 - alpha) y_{n+1} + alpha y_n, with Newmark's x_{n+1} and v_{n+1}. Order 2 with the
/// algorithmic acceleration carried and the load at the method's own time; unconditionally stable for linear motion.
/// One stage solve a step, contact by Newton in stop space.
///
/// Steps by AccelerationError, which sees velocity too, from the accelerations that meet the balance. Those are of an
/// instant within the step, where a stop that closes later is still open: where a stop closed or opened, or a load or
/// its slope jumps, the controlled variants judge and go on with the acceleration of the end itself (one evaluation
/// and one solve with M, at jumps of loads two, for its rate).
/// The algorithmic a_n is that of t_n + (alpha_m - alpha_f) h, as the expansion of the balance in h shows; where h
/// changes it is taken anew from the balanced ones, or every change of step would cost an order. Orders are checked in
/// tests/conformance.
class GeneralizedAlpha final : public time::Integrator {
 public:
  /// Without a goal: fixed steps.
  GeneralizedAlpha(dynamics::Dynamics& dynamics, AlphaParameters parameters, const std::optional<Goal>& goal);

  const time::StepController* controller() const override { return control_ ? &control_->controller() : nullptr; }
  double first_step(const time::State&) const override { return control_ ? control_->first_step() : 0.0; }

 private:
  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  /// Fills old_a_ with a_n as a step of h needs it.
  void take_acceleration(const time::State& from, double h);
  /// Gives a state behind which another motion begins the rate of its acceleration, by one more evaluation.
  void take_slope(const time::Step& step, time::State& to);

  AlphaParameters parameters_;
  StageSolver stage_;
  std::optional<AccelerationError> control_;
  std::optional<ContactOnTheWay> contact_;
  std::vector<double> discontinuities_;  ///< instants at which a load or its slope jumps, s
  Vector x_, v_, a_, old_a_;
};

}  // namespace butee::integrators

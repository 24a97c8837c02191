#pragma once

#include <memory>

#include "integrators/runge_kutta4.hpp"

namespace butee::integrators {

/// Constant factors: if er <= eps0/100, h := b h; if er <= eps0, h stays; else the step is repeated
/// with h/a.
class FixedFactors final : public time::StepController {
 public:
  FixedFactors(double tolerance, double shrink, double grow) : tolerance_(tolerance), shrink_(shrink), grow_(grow) {}
  time::StepDecision decide(double h, const time::StepReport& report) const override;

 private:
  double tolerance_, shrink_, grow_;
};

/// Factors from the error: if er <= eps0, h := s h (eps0/er)^0.2; else the step is repeated with s
/// h (eps0/er)^0.25.
class ErrorScaled final : public time::StepController {
 public:
  ErrorScaled(double tolerance, double safety) : tolerance_(tolerance), safety_(safety) {}
  time::StepDecision decide(double h, const time::StepReport& report) const override;

 private:
  double tolerance_, safety_;
};

/// Classical Runge-Kutta: one step of h is compared with two of h/2; the result of the two is kept
/// (no extrapolation).
///
///     er = max over all DOFs of |dx| and |dv|, over 15
///
/// rk4_fixed_factors (RK4-2) uses FixedFactors, rk4_error_scaled (RK4-3) ErrorScaled. The measure
/// er is absolute and mixes m, rad, m/s and rad/s. Ten evaluations per attempt and one more per
/// accepted step. Source: W. H. Press et al., Numerical Recipes, 2nd ed., section 16.2.
class StepDoublingRungeKutta4 final : public time::Integrator {
 public:
  StepDoublingRungeKutta4(dynamics::Dynamics& dynamics, std::unique_ptr<time::StepController> controller)
      : Integrator(dynamics), kernel_(dynamics), controller_(std::move(controller)) {}

  time::Traits traits() const override { return {.starts_as_published = true}; }
  const time::StepController* controller() const override { return controller_.get(); }

 private:
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  RungeKutta4Kernel kernel_;
  std::unique_ptr<time::StepController> controller_;
  Vector whole_x_, whole_v_, half_x_, half_v_, half_a_;
};

}  // namespace butee::integrators

#pragma once

#include <optional>

#include "integrators/acceleration_error.hpp"
#include "integrators/stage_solver.hpp"

namespace butee::integrators {

/// The stage of a midpoint rule in which each stop exerts the discrete gradient of its energy
/// between the old and the new displacement, f = -[U(w_1) - U(w_0)]/(w_1 - w_0). The work of this
/// force equals the change of stored energy.
class DiscreteGradientStage final : public StageSolver {
 public:
  using StageSolver::StageSolver;

  /// Sets the displacements of the stops at the start of the step.
  void begin(ConstVectorRef x);

 private:
  void contact(ConstVectorRef w, bool with_tangent, VectorRef f, VectorRef k) override;

  Vector start_, end_, force_start_, force_end_, tangent_end_;
};

/// discrete_gradient: the midpoint rule with the discrete gradient of the stops' energy.
///
///     M (v_{n+1} - v_n)/h + C v_m + K x_m = F(t_n + h/2) + f(w_n, w_{n+1}),   x_m and v_m halfway
///
/// Without damping and load, energy is conserved exactly across any change of contact and for any
/// step size. The trapezoidal Newmark method can gain energy at a stop; this method cannot. Order
/// 2; one stage solve per step; the acceleration at the end is that of the equations of motion.
/// Checked in tests/verification/energy_at_stops_test.cpp and in tests/conformance. Source: O.
/// Gonzalez, J. Nonlinear Sci. 6 (1996) 449-467, doi 10.1007/BF02440162.
class DiscreteGradient final : public time::Integrator {
 public:
  /// Without a goal the step size is fixed.
  DiscreteGradient(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal);

  const time::StepController* controller() const override { return control_ ? &control_->controller() : nullptr; }
  double first_step(const time::State&) const override { return control_ ? control_->first_step() : 0.0; }

 private:
  void do_start(time::State& state) override;
  void do_jump(time::State& state, ConstVectorRef jump) override {
    if (control_) AccelerationError::add_jump(state, jump);
  }
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  DiscreteGradientStage stage_;
  std::optional<AccelerationError> control_;
  Vector x_, v_, a_;
};

}  // namespace butee::integrators

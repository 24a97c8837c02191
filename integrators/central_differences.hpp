#pragma once

#include <optional>

#include "integrators/acceleration_error.hpp"

namespace butee::integrators {

/// central_differences: explicit, in velocity Verlet form.
///
///     v_{n+1/2} = v_n + h/2 a_n,  x_{n+1} = x_n + h v_{n+1/2},  v_{n+1} = v_{n+1/2} + h/2 a_{n+1},
///     M a_{n+1} = F(t_{n+1}) + F_c(x_{n+1}) - C (v_{n+1/2} + h/2 a_n) - K x_{n+1}
///
/// Order 2 in x and v, also with damping; one evaluation per step; stable up to h omega = 2 without
/// damping, less with damping. AccelerationError controls the step size. Orders are checked in
/// tests/conformance. Source: T. Belytschko, W. K. Liu and B. Moran, Nonlinear Finite Elements for
/// Continua and Structures, section 6.2.
class CentralDifferences final : public time::Integrator {
 public:
  /// Without a goal the step size is fixed.
  CentralDifferences(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal);

  const time::StepController* controller() const override { return control_ ? &control_->controller() : nullptr; }
  double first_step(const time::State&) const override { return control_ ? control_->first_step() : 0.0; }

 private:
  void do_start(time::State& state) override;
  void do_jump(time::State& state, ConstVectorRef jump) override {
    if (control_) AccelerationError::add_jump(state, jump);
  }
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  std::optional<AccelerationError> control_;
  Vector guess_;
};

}  // namespace butee::integrators

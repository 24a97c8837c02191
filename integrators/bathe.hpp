#pragma once

#include <optional>

#include "integrators/local_error.hpp"
#include "integrators/stage_solver.hpp"

namespace butee::integrators {

/// bathe: the trapezoidal rule to t + gamma h, then the three-point backward difference formula.
/// With gamma = 2 - sqrt(2) both stages use the same matrix (TR-BDF2).
///
/// Order 2, L-stable: unresolved frequencies are damped within one step. Two stage solves per step,
/// contact by Newton's method in stop space. The embedded formula of order 3 in displacement and
/// velocity controls the step size. Orders are checked in tests/conformance. Sources: K. J. Bathe
/// and M. M. I. Baig, Comput. Struct. 83 (2005) 2513-2524, doi 10.1016/j.compstruc.2005.08.001; M.
/// E. Hosea and L. F. Shampine, Appl. Numer. Math. 20 (1996) 21-37, doi
/// 10.1016/0168-9274(95)00115-8.
class Bathe final : public time::Integrator {
 public:
  /// Without a goal the step size is fixed.
  Bathe(dynamics::Dynamics& dynamics, const std::optional<Goal>& goal);

  const time::StepController* controller() const override { return control_ ? &control_->controller() : nullptr; }
  double first_step(const time::State&) const override { return control_ ? control_->first_step() : 0.0; }

 private:
  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  StageSolver stage_;
  std::optional<LocalErrorControl> control_;
  Vector x_, v_, a_, error_x_, error_v_;
};

}  // namespace butee::integrators

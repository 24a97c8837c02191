#pragma once

#include <optional>

#include "integrators/local_error.hpp"
#include "integrators/stage_solver.hpp"

namespace butee::integrators {

/// bathe: the trapezoidal rule to t + gamma h, then the backward difference formula of three points; gamma = 2 - sqrt
/// 2, with which both solve with the same matrix (TR-BDF2).
///
/// Order 2, L-stable: it damps what the step does not resolve at once. Two stage solves a step, contact by Newton in
/// stop space. Steps by the embedded formula of order 3 in displacement and velocity. Orders are checked in
/// tests/conformance. Sources: K. J. Bathe and M. M. I. Baig, Comput. Struct. 83 (2005) 2513-2524, doi
/// 10.1016/j.compstruc.2005.08.001; M. E. Hosea and L. F. Shampine, Appl. Numer. Math. 20 (1996) 21-37, doi
/// 10.1016/0168-9274(95)00115-8.
class Bathe final : public time::Integrator {
 public:
  /// Without a goal: fixed steps.
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

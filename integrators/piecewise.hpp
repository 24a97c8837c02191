#pragma once

#include "butee/time/integrator.hpp"
#include "integrators/piecewise_motion.hpp"

namespace butee::integrators {

/// piecewise: the motion in closed form from one change of contact to the next; every change is
/// located.
///
/// For few DOFs and stops with the linear law, elastic or with Kelvin-Voigt dissipation. A contact
/// state is the set of closed stops. Between two changes the system is linear, and x(t) follows
/// from the modes of the contact state, which are computed when the state first occurs and then
/// kept. There is no truncation error and no step size; the cost is a few evaluations per change of
/// contact. Errors are rounding errors times the growth of disturbances. Theory: piecewise.md.
/// Checked in tests/models/piecewise_test.cpp.
class Piecewise final : public time::Integrator {
 public:
  /// `end_time` in s. Throws InputError for any other scene; the message names suitable methods.
  Piecewise(dynamics::Dynamics& dynamics, double end_time);

  time::Traits traits() const override { return {.handles_load_discontinuities = true}; }
  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State&) const override { return std::numeric_limits<double>::infinity(); }
  /// The derivative of (x, v) at the end of an accepted step with respect to (x, v) at its start, 2n x 2n: the product
  /// of those of its pieces, and of what a stop with dissipation adds where its force jumps. At grazing contact, where
  /// it does not exist, that of the pieces taken. Over several steps: the product.
  Eigen::MatrixXd derivative(const time::State& from, const time::State& to) { return motion_.derivative(from, to); }
  /// The derivative of (x, v) at the end with respect to a factor on all loads, at 1, in this step alone, 2n. Over
  /// several steps: s := derivative() s + this.
  Vector derivative_by_loads(const time::State& from, const time::State& to) {
    return motion_.derivative_by_loads(from, to);
  }

 private:
  /// Accepts every step and proposes the longest possible next step.
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport&) const override {
      return {true, std::numeric_limits<double>::infinity()};
    }
  };
  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return motion_; }

  Controller controller_;
  PiecewiseMotion motion_;  ///< of the last step
};

}  // namespace butee::integrators

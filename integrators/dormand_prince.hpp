#pragma once

#include <array>

#include "integrators/local_error.hpp"
#include "integrators/quintic.hpp"
#include "integrators/stiffness_watch.hpp"

namespace butee::integrators {

/// dopri5: Dormand and Prince's explicit Runge-Kutta method of order 5 with an embedded one of order 4, on (x, v).
///
/// Six evaluations per step; the last is the first of the next step. PI control of the step size by
/// the local error; interpolation by the quintic through x, v and a at both ends. Stable for
/// undamped motion up to about h omega = 1.0 (with slight growth or decay below), on the negative
/// real axis up to 3.3. A message is logged if stability instead of accuracy limits the steps.
/// Order is checked in tests/conformance. Source: J. R. Dormand and P. J. Prince, J. Comput. Appl.
/// Math. 6 (1980) 19-26, doi 10.1016/0771-050X(80)90013-3.
class DormandPrince final : public time::Integrator {
 public:
  DormandPrince(dynamics::Dynamics& dynamics, const Goal& goal);

  const time::StepController* controller() const override { return &control_.controller(); }
  double first_step(const time::State&) const override { return control_.first_step(); }
  time::Traits traits() const override {
    return {.follows_contact_phases = true, .velocity_uncertainty = control_.velocity_uncertainty()};
  }

 private:
  static constexpr std::size_t kStages = 7;

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return quintic_; }

  LocalErrorControl control_;
  QuinticInterpolant quintic_;
  StiffnessWatch stiffness_;
  std::array<Vector, kStages> v_, a_;  ///< one per stage
  Vector x_, x_before_, error_x_, error_v_;
};

}  // namespace butee::integrators

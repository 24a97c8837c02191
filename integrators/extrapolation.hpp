#pragma once

#include <array>

#include "integrators/local_error.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// extrapolation8: Gragg's modified midpoint rule on (x, v) with 2, 4, 6 and 8 parts of a step, extrapolated to
/// order 8.
///
///     z_{m+1} = z_{m-1} + 2 (h/n) f(z_m),   S = (z_n + z_{n-1} + (h/n) f(z_n))/2,
///     T_jk = T_j,k-1 + (T_j,k-1 - T_j-1,k-1)/((n_j/n_j-k+1)^2 - 1)
///
/// Explicit, 25 evaluations per step; suited to tight tolerances and smooth motion. The difference
/// from the result of order 6 is the error estimate. Interpolation by the quintic through both
/// ends. Order is checked in tests/conformance. Source: E. Hairer, S. P. Norsett and G. Wanner,
/// Solving Ordinary Differential Equations I, II.9.
class Extrapolation final : public time::Integrator {
 public:
  Extrapolation(dynamics::Dynamics& dynamics, const Goal& goal);

  const time::StepController* controller() const override { return &control_.controller(); }
  double first_step(const time::State&) const override { return control_.first_step(); }
  /// It lands on outputs since the steps are long and interpolation has a lower order than the steps.
  time::Traits traits() const override {
    return {.follows_contact_phases = true,
            .lands_on_outputs = true,
            .velocity_uncertainty = control_.velocity_uncertainty()};
  }

 private:
  static constexpr std::size_t kColumns = 4;

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return quintic_; }
  /// The modified midpoint rule with `parts` parts of the step and Gragg's smoothing.
  void midpoint(const time::State& from, const time::Step& step, int parts, Vector& x, Vector& v);

  LocalErrorControl control_;
  QuinticInterpolant quintic_;
  std::array<Vector, kColumns> x_, v_;  ///< a row of the extrapolation tableau
  Vector old_x_, old_v_, new_x_, new_v_, a_, next_x_, next_v_;
};

}  // namespace butee::integrators

#pragma once

#include <array>

#include "butee/dynamics/tangent_solver.hpp"
#include "integrators/local_error.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// rodas4: the Rosenbrock method RODAS4(3) of six stages, in n x n form.
///
///     (1/(gamma h) - J) U_i = f(y + sum_j a_ij U_j) + sum_j c_ij U_j/h + gamma_i h f_t,    y = (x, v), U = (P, Q)
///
/// The displacement part of each stage is eliminated, P = gamma h (R_x + Q), which leaves (M +
/// gamma h C + (gamma h)^2 (K + K_t)) Q = gamma h (M R_v - gamma h (K + K_t) R_x) with the tangent
/// stiffness K_t of the stops at the start of the step: one matrix and six solves per step, no
/// Newton iteration.
///
/// Order 4 in displacement and velocity, stiffly accurate and L-stable; the embedded method of
/// order 3 gives the error estimate of both. Order is checked in tests/conformance. Source: E.
/// Hairer and G. Wanner, Solving Ordinary Differential Equations II, section IV.7 and the program
/// RODAS.
class Rodas4 final : public time::Integrator {
 public:
  Rodas4(dynamics::Dynamics& dynamics, const Goal& goal);

  const time::StepController* controller() const override { return &control_.controller(); }
  double first_step(const time::State&) const override { return control_.first_step(); }
  time::Traits traits() const override { return {.follows_contact_phases = true}; }

 private:
  static constexpr std::size_t kStages = 6;

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return quintic_; }
  /// (K + K_t) y into work_
  void tangent_force(ConstVectorRef y);

  LocalErrorControl control_;
  QuinticInterpolant quintic_;
  std::array<Vector, kStages> p_, q_;
  Vector x_, v_, rate_, residual_x_, residual_v_, work_, other_;
  Vector stop_displacement_, stop_force_, tangent_, stop_work_;
  dynamics::TangentSolver solver_;
  std::span<const dynamics::Obstacles::Tangent> obstacles_;  ///< obstacles that exert a force at the start of the step
};

}  // namespace butee::integrators

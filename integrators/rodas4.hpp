#pragma once

#include <array>

#include "butee/dynamics/tangent_solver.hpp"
#include "integrators/local_error.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// The motion within the steps of Rodas4: the quintic through both ends, or, where a step is far longer than the
/// fastest motion, the method's own dense output, a cubic for x and one for v. An error e of x at the end of such a
/// step is one of omega^2 e in its acceleration, which would bend the quintic by (h omega)^2 e/64: little for a
/// displacement, many times its value for a force of a beam, a difference of displacements. The dense output reduces
/// fast motion as the step does. Checked in tests/models/forces_of_long_steps_test.cpp.
class Rodas4Output final : public time::Interpolant {
 public:
  static constexpr std::size_t kStages = 6;
  using Stages = std::array<Vector, kStages>;

  /// The step that was computed last, with its stages (P, Q), which must stay valid until the next call. `is_long`: it
  /// is far longer than the fastest motion.
  void accept(double begin, double end, bool is_long, const Stages& p, const Stages& q);

  time::Interpolation interpolation() const override {
    return is_long_ ? time::Interpolation::near_quintic : time::Interpolation::quintic;
  }
  std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail detail) override;
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override;

 private:
  bool holds(const time::State& from, const time::State& to) const { return from.t == begin_ && to.t == end_; }

  QuinticInterpolant quintic_;
  double begin_ = 0.0, end_ = -1.0;  ///< the step, s
  bool is_long_ = false;
  const Stages *p_ = nullptr, *q_ = nullptr;
  std::array<double, 3> breakpoints_{};
};

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
  time::Traits traits() const override {
    return {.follows_contact_phases = true, .velocity_uncertainty = control_.velocity_uncertainty()};
  }

 private:
  static constexpr std::size_t kStages = Rodas4Output::kStages;

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return output_; }
  /// (K + K_t) y into work_
  void tangent_force(ConstVectorRef y);

  LocalErrorControl control_;
  Rodas4Output output_;
  Rodas4Output::Stages p_, q_;
  Vector x_, v_, rate_, residual_x_, residual_v_, work_, other_;
  Vector stop_displacement_, stop_force_, tangent_, stop_work_;
  dynamics::TangentSolver solver_;
  std::span<const dynamics::Obstacles::Tangent> obstacles_;  ///< obstacles that exert a force at the start of the step
};

}  // namespace butee::integrators

#pragma once

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// The classical Runge-Kutta step of order 4 for (x, v), with the acceleration at its start given.
///
///     k_1 = a(t, x, v),  k_2, k_3 at t + h/2,  k_4 at t + h;  three evaluations in addition to the given one
class RungeKutta4Kernel {
 public:
  explicit RungeKutta4Kernel(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}

  /// Advances (x, v) with acceleration a over h, from t to t_end, to (x_new, v_new).
  void advance(double t, double h, double t_end, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, VectorRef x_new,
               VectorRef v_new);

 private:
  dynamics::Dynamics& dynamics_;
  Vector x_, v_, a2_, a3_, a4_;
};

/// rk4 (RK4-1): classical Runge-Kutta with fixed steps.
///
/// Order 4 in x and v; stable for undamped motion up to h omega = 2 sqrt(2) and on the negative
/// real axis up to 2.785; four evaluations per step. A step with a change of contact loses this
/// order. Order and stability are checked in tests/conformance. Source: W. Kutta, Z. Math. Phys. 46
/// (1901) 435-453.
class RungeKutta4 final : public time::Integrator {
 public:
  explicit RungeKutta4(dynamics::Dynamics& dynamics) : Integrator(dynamics), kernel_(dynamics) {}

  time::Traits traits() const override { return {.starts_as_published = true}; }

 private:
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  RungeKutta4Kernel kernel_;
};

}  // namespace butee::integrators

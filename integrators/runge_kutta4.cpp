#include "integrators/runge_kutta4.hpp"

#include <butee/core/blocks.hpp>
#include <butee/core/zeros.hpp>

#include "integrators/methods.hpp"

namespace butee::integrators {

void RungeKutta4Kernel::advance(double t, double h, double t_end, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a,
                                VectorRef x_new, VectorRef v_new) {
  const Index n = x.size();
  for (Vector* vector : {&x_, &v_, &a2_, &a3_, &a4_}) make_room(*vector, n);
  const double *x0 = x.data(), *v0 = v.data(), *a1 = a.data(), *a2 = a2_.data(), *a3 = a3_.data(), *a4 = a4_.data();
  double *xs = x_.data(), *vs = v_.data(), *x1 = x_new.data(), *v1 = v_new.data();

  // The slopes of x are the velocities of the stages, v plus the stage offset times the
  // acceleration of the stage before.
  const double half = 0.5 * h, square = h * h;
  for_rows(n, [=](Index i) {
    xs[i] = x0[i] + half * v0[i];
    vs[i] = v0[i] + half * a1[i];
  });
  dynamics_.acceleration(t + half, x_, v_, a2_);
  for_rows(n, [=](Index i) {
    xs[i] = x0[i] + half * v0[i] + 0.25 * square * a1[i];
    vs[i] = v0[i] + half * a2[i];
  });
  dynamics_.acceleration(t + half, x_, v_, a3_);
  for_rows(n, [=](Index i) {
    xs[i] = x0[i] + h * v0[i] + 0.5 * square * a2[i];
    vs[i] = v0[i] + h * a3[i];
  });
  dynamics_.acceleration(t_end, x_, v_, a4_);
  for_rows(n, [=](Index i) {
    x1[i] = x0[i] + h * v0[i] + square / 6.0 * (a1[i] + a2[i] + a3[i]);
    v1[i] = v0[i] + h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
  });
}

time::StepReport RungeKutta4::do_step(const time::State& from, const time::Step& step, time::State& to) {
  kernel_.advance(from.t, step.h, step.t_end, from.x, from.v, from.a, to.x, to.v);
  dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  return {};
}

time::IntegratorType rk4_type() {
  return {.name = "rk4",
          .aliases = {"RK4-1"},
          .summary = "classical Runge-Kutta of order 4, fixed steps",
          .order = 4.0,
          .stability_limit = kRungeKutta4Limit,
          .damping_limit = kRungeKutta4DampingLimit,
          .fixed_step = true,
          .contacts = time::ContactSupport::without_memory,
          .make = [](const config::Parameters&, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<RungeKutta4>(dynamics);
          }};
}

}  // namespace butee::integrators

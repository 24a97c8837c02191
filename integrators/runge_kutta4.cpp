#include "integrators/runge_kutta4.hpp"

#include "integrators/methods.hpp"

namespace butee::integrators {

void RungeKutta4Kernel::advance(double t, double h, double t_end, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a,
                                VectorRef x_new, VectorRef v_new) {
  const Index n = x.size();
  for (Vector* vector : {&x_, &v2_, &v3_, &v4_, &a2_, &a3_, &a4_}) vector->resize(n);

  x_ = x + 0.5 * h * v;
  v2_ = v + 0.5 * h * a;
  dynamics_.acceleration(t + 0.5 * h, x_, v2_, a2_);

  x_ = x + 0.5 * h * v2_;
  v3_ = v + 0.5 * h * a2_;
  dynamics_.acceleration(t + 0.5 * h, x_, v3_, a3_);

  x_ = x + h * v3_;
  v4_ = v + h * a3_;
  dynamics_.acceleration(t_end, x_, v4_, a4_);

  x_new = x + h / 6.0 * (v + 2.0 * v2_ + 2.0 * v3_ + v4_);
  v_new = v + h / 6.0 * (a + 2.0 * a2_ + 2.0 * a3_ + a4_);
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
          .make = [](const config::Parameters&, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<RungeKutta4>(dynamics);
          }};
}

}  // namespace butee::integrators

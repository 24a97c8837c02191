#include "integrators/runge_kutta4.hpp"

#include <butee/core/blocks.hpp>

#include "integrators/methods.hpp"

namespace butee::integrators {

void RungeKutta4Kernel::advance(double t, double h, double t_end, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a,
                                VectorRef x_new, VectorRef v_new) {
  const Index n = x.size();
  for (Vector* vector : {&x_, &v2_, &v3_, &v4_, &a2_, &a3_, &a4_}) vector->resize(n);

  const auto stage = [&](double on, ConstVectorRef slope_x, ConstVectorRef slope_v, Vector& v_stage) {
    in_blocks(n, [&](Index begin, Index count) {
      x_.segment(begin, count) = x.segment(begin, count) + on * slope_x.segment(begin, count);
      v_stage.segment(begin, count) = v.segment(begin, count) + on * slope_v.segment(begin, count);
    });
  };
  stage(0.5 * h, v, a, v2_);
  dynamics_.acceleration(t + 0.5 * h, x_, v2_, a2_);
  stage(0.5 * h, v2_, a2_, v3_);
  dynamics_.acceleration(t + 0.5 * h, x_, v3_, a3_);
  stage(h, v3_, a3_, v4_);
  dynamics_.acceleration(t_end, x_, v4_, a4_);
  in_blocks(n, [&](Index begin, Index count) {
    const auto of = [&](const auto& vector) { return vector.segment(begin, count); };
    x_new.segment(begin, count) = of(x) + h / 6.0 * (of(v) + 2.0 * of(v2_) + 2.0 * of(v3_) + of(v4_));
    v_new.segment(begin, count) = of(v) + h / 6.0 * (of(a) + 2.0 * of(a2_) + 2.0 * of(a3_) + of(a4_));
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
          .make = [](const config::Parameters&, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<RungeKutta4>(dynamics);
          }};
}

}  // namespace butee::integrators

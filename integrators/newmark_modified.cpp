#include "integrators/newmark_modified.hpp"

#include <butee/core/blocks.hpp>

#include "integrators/methods.hpp"

namespace butee::integrators {

using config::Parameters;
using time::IntegratorType;
using time::State;
using time::StepReport;

ModifiedNewmark::ModifiedNewmark(dynamics::Dynamics& dynamics, NewmarkParameters parameters,
                                 std::unique_ptr<ZienkiewiczXie> controller)
    : Integrator(dynamics), parameters_(parameters), controller_(std::move(controller)) {
  secant_ = offset_ = Vector::Zero(dynamics.stop_count());
}

StepReport ModifiedNewmark::do_step(const State& from, const time::Step& step, State& to) {
  const double h = step.h, beta = parameters_.beta, gamma = parameters_.gamma;
  const double velocity_factor = gamma * h, displacement_factor = beta * h * h;
  const double *x0 = from.x.data(), *v0 = from.v.data(), *a0 = from.a.data();
  double *x = to.x.data(), *v = to.v.data(), *a = to.a.data();
  for_rows(to.x.size(), [=](Index i) {
    x[i] = x0[i] + h * v0[i] + (0.5 - beta) * h * h * a0[i];
    v[i] = v0[i] + (1.0 - gamma) * h * a0[i];
  });
  if (dynamics().stop_count() > 0) dynamics().secant_contact(from.x, secant_, offset_);
  StepReport report;
  if (!dynamics().solve_secant(step.t_end, velocity_factor, displacement_factor, secant_, offset_, to.x, to.v, to.a)) {
    report.status = time::StepStatus::singular;
    return report;
  }
  for_rows(to.x.size(), [=](Index i) {
    x[i] += displacement_factor * a[i];
    v[i] += velocity_factor * a[i];
  });
  if (controller_ != nullptr) report.error = controller_->error(from, to, h);
  return report;
}

IntegratorType newmark_modified_type() {
  return {.name = "newmark_modified",
          .aliases = {"NMM1"},
          .summary = "Newmark with the stops' secant stiffness of the last step instead of Newton, fixed steps",
          .parameters = NewmarkParameters::declare(),
          .order = 2.0,
          .fixed_step = true,
          .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<ModifiedNewmark>(dynamics, NewmarkParameters::read(p));
          }};
}

IntegratorType newmark_modified_adaptive_type() {
  std::vector<config::Parameter> parameters = NewmarkParameters::declare();
  for (const config::Parameter& parameter : ZienkiewiczXie::parameters()) parameters.push_back(parameter);
  return {.name = "newmark_modified_adaptive",
          .aliases = {"NMM2"},
          .summary = "Newmark with the stops' secant stiffness of the last step, steps by Zienkiewicz and Xie's error",
          .parameters = std::move(parameters),
          .order = 2.0,
          .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<ModifiedNewmark>(dynamics, NewmarkParameters::read(p), ZienkiewiczXie::make(p));
          },
          .check = ZienkiewiczXie::check};
}

}  // namespace butee::integrators

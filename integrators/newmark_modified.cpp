#include "integrators/newmark_modified.hpp"

#include <butee/core/blocks.hpp>

#include "integrators/methods.hpp"

namespace butee::integrators {

using config::Parameters;
using time::IntegratorType;
using time::State;
using time::StepReport;

ModifiedNewmark::ModifiedNewmark(solve::Dynamics& dynamics, NewmarkParameters parameters,
                                 std::unique_ptr<ZienkiewiczXie> controller)
    : Integrator(dynamics), parameters_(parameters), controller_(std::move(controller)) {
  secant_ = offset_ = Vector::Zero(dynamics.stop_count());
}

StepReport ModifiedNewmark::do_step(const State& from, const time::Step& step, State& to) {
  const double h = step.h, beta = parameters_.beta, gamma = parameters_.gamma;
  const double on_v = gamma * h, on_x = beta * h * h;
  in_blocks(to.x.size(), [&](Index begin, Index count) {
    const auto v = from.v.segment(begin, count), a = from.a.segment(begin, count);
    to.x.segment(begin, count) = from.x.segment(begin, count) + h * v + (0.5 - beta) * h * h * a;
    to.v.segment(begin, count) = v + (1.0 - gamma) * h * a;
  });

  if (dynamics().stop_count() > 0) dynamics().secant_contact(from.x, secant_, offset_);
  StepReport report;
  if (!dynamics().solve_secant(step.t_end, on_v, on_x, secant_, offset_, to.x, to.v, to.a)) {
    report.status = time::StepStatus::singular;
    return report;
  }
  in_blocks(to.x.size(), [&](Index begin, Index count) {
    const auto a = to.a.segment(begin, count);
    to.x.segment(begin, count) += on_x * a;
    to.v.segment(begin, count) += on_v * a;
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
          .make = [](const Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
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
          .make = [](const Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<ModifiedNewmark>(dynamics, NewmarkParameters::read(p), ZienkiewiczXie::make(p));
          },
          .check = ZienkiewiczXie::check};
}

}  // namespace butee::integrators

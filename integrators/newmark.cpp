#include "integrators/newmark.hpp"

#include <cmath>
#include <limits>

#include <butee/core/blocks.hpp>

#include "integrators/methods.hpp"

namespace butee::integrators {

using config::number;
using config::Parameter;
using config::Parameters;
using time::IntegratorType;
using time::State;
using time::StepReport;

std::vector<Parameter> NewmarkParameters::declare() {
  return {
      number("beta", "1", "Newmark's beta").at_least(0).at_most(1).or_else(0.25),
      number("gamma", "1", "Newmark's gamma; below 1/2 every step gains energy").at_least(0.5).at_most(1).or_else(0.5)};
}

NewmarkParameters NewmarkParameters::read(const Parameters& p) {
  return {p.number("beta"), p.number("gamma")};
}

double NewmarkParameters::stability_limit() const {
  const double excess = 0.5 * gamma - beta;
  return excess > 0.0 ? 1.0 / std::sqrt(excess) : std::numeric_limits<double>::infinity();
}

Newmark::Newmark(dynamics::Dynamics& dynamics, NewmarkParameters parameters, NewtonOptions newton,
                 std::unique_ptr<ZienkiewiczXie> controller)
    : Integrator(dynamics), parameters_(parameters), stage_(dynamics, newton), controller_(std::move(controller)) {}

StepReport Newmark::do_step(const State& from, const time::Step& step, State& to) {
  const double h = step.h;
  const double *x0 = from.x.data(), *v0 = from.v.data(), *a0 = from.a.data();
  double *x = to.x.data(), *v = to.v.data(), *a = to.a.data();
  for_rows(to.x.size(), [=](Index i) {
    a[i] = a0[i];
    x[i] = x0[i] + h * v0[i] + 0.5 * h * h * a0[i];
    v[i] = v0[i] + h * a0[i];
  });
  StepReport report = stage_.solve(step.t_end, parameters_.gamma * h, parameters_.beta * h * h, to.x, to.v, to.a);
  if (controller_ != nullptr && report.status == time::StepStatus::ok) report.error = controller_->error(from, to, h);
  return report;
}

namespace {

std::vector<Parameter> newton_parameters() {
  std::vector<Parameter> all = NewmarkParameters::declare();
  all.push_back(
      number("residual_tolerance", "1", "eps_r, relative to the sum of the force norms").above(0).or_else(1e-9));
  all.push_back(number("increment_tolerance", "1", "eps_delta, relative to the norm of the displacements")
                    .above(0)
                    .or_else(1e-9));
  all.push_back(config::integer("max_iterations", "i_max, the largest number of linear solves in a step")
                    .at_least(1)
                    .at_most(1000)
                    .or_else(std::int64_t{20}));
  all.push_back(
      config::text("on_newton_failure",
                   "if they do not suffice: stop ends the run, or halves an adaptive step; keep keeps the step")
          .one_of({"stop", "keep"})
          .or_else("stop"));
  return all;
}

NewtonOptions newton_options(const Parameters& p) {
  return {p.number("residual_tolerance"), p.number("increment_tolerance"),
          static_cast<int>(p.integer("max_iterations")), p.text("on_newton_failure") == "keep"};
}

}  // namespace

IntegratorType newmark_type() {
  return {.name = "newmark",
          .aliases = {"NM1"},
          .summary = "Newmark with Newton-Raphson, fixed steps",
          .parameters = newton_parameters(),
          .order = 2.0,
          .fixed_step = true,
          .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Newmark>(dynamics, NewmarkParameters::read(p), newton_options(p));
          }};
}

IntegratorType newmark_adaptive_type() {
  std::vector<Parameter> parameters = newton_parameters();
  for (const Parameter& parameter : ZienkiewiczXie::parameters()) parameters.push_back(parameter);
  return {.name = "newmark_adaptive",
          .aliases = {"NM2"},
          .summary = "Newmark with Newton-Raphson, steps by Zienkiewicz and Xie's error",
          .parameters = std::move(parameters),
          .order = 2.0,
          .make = [](const Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Newmark>(dynamics, NewmarkParameters::read(p), newton_options(p),
                                             ZienkiewiczXie::make(p));
          },
          .check = ZienkiewiczXie::check};
}

}  // namespace butee::integrators

#include "integrators/stage_solver.hpp"

#include <cmath>

#include <butee/core/blocks.hpp>

namespace butee::integrators {

using time::StepReport;
using time::StepStatus;

StageSolver::StageSolver(solve::Dynamics& dynamics, NewtonOptions options) : dynamics_(dynamics), options_(options) {
  load_ = residual_ = Vector::Zero(dynamics.size());
  stop_displacement_ = stop_force_ = stop_tangent_ = Vector::Zero(dynamics.stop_count());
}

StepReport StageSolver::solve(double t, double on_v, double on_x, VectorRef x, VectorRef v, VectorRef a) {
  dynamics_.external_force(t, load_);
  solve::EffectiveSolver& effective = dynamics_.effective();
  effective.set_factors(on_v, on_x);
  const bool has_stops = dynamics_.stop_count() > 0;
  StepReport report;
  double increment = 0.0;
  while (true) {
    // The first look always leads to a solve, except at rest; later ones seldom do, and ask for the tangent then.
    const bool first = report.newton_iterations == 0;
    const solve::ForceBalance balance = evaluate_residual(x, v, a, first);
    if (!std::isfinite(balance.scale())) {
      report.status = StepStatus::not_finite;
      return report;
    }
    const bool is_balanced = balance.residual() <= options_.residual_tolerance * balance.scale();
    if (is_balanced && (first || increment <= options_.increment_tolerance * x.norm())) return report;
    if (report.newton_iterations == options_.max_iterations) break;
    if (!first && has_stops) contact(stop_displacement_, true, stop_force_, stop_tangent_);
    if (!effective.solve(stop_tangent_, residual_)) {
      report.status = StepStatus::singular;
      return report;
    }
    ++report.newton_iterations;
    const double correction = on_x * add_correction(on_v, on_x, x, v, a);
    if (!has_stops && !options_.checks_linear_too) return report;
    increment = correction;
  }
  residual_.cwiseAbs().maxCoeff(&report.worst_dof);
  report.kept_failure = options_.keep_failures;
  report.status = options_.keep_failures ? StepStatus::ok : StepStatus::newton_failed;
  return report;
}

double StageSolver::add_correction(double on_v, double on_x, VectorRef x, VectorRef v, VectorRef a) const {
  double square = 0.0;
  in_blocks(a.size(), [&](Index begin, Index count) {
    const auto correction = residual_.segment(begin, count);
    a.segment(begin, count) += correction;
    v.segment(begin, count) += on_v * correction;
    x.segment(begin, count) += on_x * correction;
    square += correction.squaredNorm();
  });
  return std::sqrt(square);
}

solve::ForceBalance StageSolver::evaluate_residual(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a,
                                                   bool with_tangent) {
  if (dynamics_.stop_count() > 0) {
    dynamics_.contact().displacement(x, stop_displacement_);
    contact(stop_displacement_, with_tangent, stop_force_, stop_tangent_);
  }
  return dynamics_.residual(load_, stop_force_, x, v, a, residual_);
}

void StageSolver::contact(ConstVectorRef w, bool with_tangent, VectorRef f, VectorRef k) {
  if (with_tangent)
    dynamics_.contact().tangent(w, f, k);
  else
    dynamics_.contact().force(w, f);
}

}  // namespace butee::integrators

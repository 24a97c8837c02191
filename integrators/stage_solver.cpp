#include "integrators/stage_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <butee/core/blocks.hpp>
#include <butee/core/zeros.hpp>

#include "integrators/magnitudes.hpp"

namespace butee::integrators {

using time::StepReport;
using time::StepStatus;

namespace {

/// A residual below this part of the sum of the magnitudes of the forces is their rounding: some operations of 1.1e-16
/// each.
constexpr double kRounding = 1e-15;

double square_of(ConstVectorRef y, Index begin, Index count) {
  return count == 1 ? y[begin] * y[begin] : y.segment(begin, count).squaredNorm();
}

}  // namespace

StageSolver::StageSolver(dynamics::Dynamics& dynamics, NewtonOptions options) : dynamics_(dynamics), options_(options) {
  load_ = zeros(dynamics.size());
  residual_ = zeros(dynamics.size());
  stop_displacement_ = stop_force_ = stop_tangent_ = Vector::Zero(dynamics.stop_count());
  stop_stiffness_ = dynamics.stops().closed_stiffness();
  magnitudes_ = zeros(dynamics.size());
  if (!options.checks_each_stop || dynamics.stop_count() == 0) return;
  expected_force_ = Vector::Zero(dynamics.stop_count());
  masses_ = dynamics.system().mass.diagonal();
}

StepReport StageSolver::solve(double t, double velocity_factor, double displacement_factor, VectorRef x, VectorRef v,
                              VectorRef a) {
  dynamics_.external_force(t, load_);
  dynamics::EffectiveSolver& effective = dynamics_.effective();
  effective.set_factors(velocity_factor, displacement_factor);
  const bool has_stops = dynamics_.stop_count() > 0;
  StepReport report;
  Change last{};
  while (true) {
    // The first residual always leads to a solve, except at rest, so that the tangent is computed
    // with it. Later residuals seldom do; the tangent is then computed on demand.
    const bool first = report.newton_iterations == 0;
    const linalg::ForceBalance balance = evaluate_residual(x, v, a, first);
    const double scale = balance.scale();
    if (!std::isfinite(scale)) {
      report.status = StepStatus::not_finite;
      return report;
    }
    if (first || displacement_factor * last.correction <= options_.increment_tolerance * last.x) {
      const bool is_small = balance.residual() <= options_.residual_tolerance * scale;
      if (is_small && (first ? options_.takes_guess : stops_agree(x, a))) return report;
      if ((is_small || !first) && is_rounding(x, v, a)) return report;
    }
    if (report.newton_iterations == options_.max_iterations) break;
    if (!first && has_stops) contact(stop_displacement_, true, stop_force_, stop_tangent_);
    if (!effective.solve(stop_tangent_, residual_)) {
      report.status = StepStatus::singular;
      return report;
    }
    ++report.newton_iterations;
    last = add_correction(velocity_factor, displacement_factor, x, v, a);
    if (!has_stops && !options_.checks_linear_too) return report;
  }
  residual_.cwiseAbs().maxCoeff(&report.worst_dof);
  report.kept_failure = options_.keep_failures;
  report.status = options_.keep_failures ? StepStatus::ok : StepStatus::newton_failed;
  return report;
}

bool StageSolver::stops_agree(ConstVectorRef x, ConstVectorRef a) const {
  const dynamics::ElasticStops& stops = dynamics_.stops();
  for (Index i = 0; i < expected_force_.size(); ++i) {
    const double misfit = std::abs(stop_force_[i] - expected_force_[i]);
    if (misfit == 0.0) continue;
    double inertia = std::numeric_limits<double>::infinity(), size = stops.play_of(i).gap;
    for (const Index dof : {stops.dof_a(i), stops.dof_b(i)}) {
      if (dof < 0) continue;
      inertia = std::min(inertia, masses_[dof] * std::abs(a[dof]));
      size += std::abs(x[dof]);
    }
    const double rounding = kRounding * std::max(stop_stiffness_[i], std::abs(stop_tangent_[i])) * size;
    if (misfit > options_.residual_tolerance * (std::abs(stop_force_[i]) + inertia) + rounding) return false;
  }
  return true;
}

bool StageSolver::is_rounding(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a) {
  const model::System& system = dynamics_.system();
  const model::Damping& damping = system.damping;
  magnitudes_ = load_.cwiseAbs();
  add_magnitudes(system.mass, 1.0, a, magnitudes_);
  add_magnitudes(system.mass, damping.mass_proportional, v, magnitudes_);
  add_magnitudes(system.stiffness, 1.0, x, magnitudes_);
  add_magnitudes(system.stiffness, damping.stiffness_proportional, v, magnitudes_);
  add_magnitudes(system.dashpots, 1.0, v, magnitudes_);
  const dynamics::ElasticStops& stops = dynamics_.stops();
  for (Index i = 0; i < stops.size(); ++i) {
    if (stop_force_[i] == 0.0) continue;
    const Index ends[] = {stops.dof_a(i), stops.dof_b(i)};
    double displacement = 0.0;
    for (const Index dof : ends)
      if (dof >= 0) displacement += std::abs(x[dof]);
    for (const Index dof : ends)
      if (dof >= 0) magnitudes_[dof] += stop_stiffness_[i] * displacement;
  }
  return (residual_.array().abs() <= kRounding * magnitudes_.array()).all();
}

StageSolver::Change StageSolver::add_correction(double velocity_factor, double displacement_factor, VectorRef x,
                                                VectorRef v, VectorRef a) {
  double square = 0.0, x_square = 0.0;
  in_blocks(a.size(), [&](Index begin, Index count) {
    const double* correction = residual_.data() + begin;
    double *x_end = x.data() + begin, *v_end = v.data() + begin, *a_end = a.data() + begin;
    for_rows(count, [=](Index i) {
      a_end[i] += correction[i];
      v_end[i] += velocity_factor * correction[i];
      x_end[i] += displacement_factor * correction[i];
    });
    square += square_of(residual_, begin, count);
    x_square += square_of(x, begin, count);
  });
  return {std::sqrt(square), std::sqrt(x_square)};
}

linalg::ForceBalance StageSolver::evaluate_residual(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a,
                                                    bool with_tangent) {
  if (dynamics_.stop_count() > 0) {
    if (expected_force_.size() > 0) expected_force_ = stop_force_ + stop_tangent_.cwiseProduct(stop_displacement_);
    dynamics_.stops().displacement(x, stop_displacement_);
    if (expected_force_.size() > 0) expected_force_ -= stop_tangent_.cwiseProduct(stop_displacement_);
    contact(stop_displacement_, with_tangent, stop_force_, stop_tangent_);
  }
  return dynamics_.residual(load_, stop_force_, x, v, a, residual_);
}

void StageSolver::contact(ConstVectorRef w, bool with_tangent, VectorRef f, VectorRef k) {
  if (with_tangent)
    dynamics_.stops().tangent(w, f, k);
  else
    dynamics_.stops().force(w, f);
}

}  // namespace butee::integrators

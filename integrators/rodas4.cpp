#include "integrators/rodas4.hpp"

#include <cmath>

#include "butee/core/error.hpp"
#include "integrators/methods.hpp"
#include "integrators/rodas4_coefficients.hpp"

namespace butee::integrators {

using namespace rodas4_coefficients;

namespace {

/// kConstant and kKink are measured in tests/conformance/error_constant_test.cpp.
constexpr double kConstant = 0.57, kContactChange = 10.0, kKink = 0.032;

/// One component of the dense output within a step.
struct Cubic {
  double rise, d, e, begin;

  Cubic(double from, double to, const Rodas4Output::Stages& stages, Index dof)
      : rise(to - from), d(0.0), e(0.0), begin(from) {
    for (std::size_t j = 0; j < kFirst.size(); ++j) {
      d += kFirst[j] * stages[j][dof];
      e += kSecond[j] * stages[j][dof];
    }
  }
  double value(double s) const { return begin + s * (rise + (1.0 - s) * (d + s * e)); }
  double slope(double s) const { return rise + (1.0 - 2.0 * s) * d + s * (2.0 - 3.0 * s) * e; }
};

}  // namespace

void Rodas4Output::accept(double begin, double end, bool is_long, const Stages& p, const Stages& q) {
  begin_ = begin;
  end_ = end;
  is_long_ = is_long;
  p_ = &p;
  q_ = &q;
  for (std::size_t i = 0; i < breakpoints_.size(); ++i)
    breakpoints_[i] = begin + (end - begin) * static_cast<double>(i + 1) / (breakpoints_.size() + 1.0);
}

std::span<const double> Rodas4Output::breakpoints(const time::State& from, const time::State& to, time::Detail detail) {
  // The power of two cubics is of degree 6, which Gauss' rule with five points integrates exactly.
  if (!is_long_ || !holds(from, to) || detail == time::Detail::power) return {};
  return breakpoints_;
}

void Rodas4Output::interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                               time::Interpolated out) {
  if (!is_long_ || !holds(from, to)) return quintic_.interpolate(from, to, t, dofs, out);
  const double h = end_ - begin_, s = (t - begin_) / h;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Index dof = dofs[i];
    if (!out.x.empty()) out.x[i] = Cubic(from.x[dof], to.x[dof], *p_, dof).value(s);
    if (out.v.empty() && out.a.empty()) continue;
    const Cubic v(from.v[dof], to.v[dof], *q_, dof);
    if (!out.v.empty()) out.v[i] = v.value(s);
    if (!out.a.empty()) out.a[i] = v.slope(s) / h;
  }
}

Rodas4::Rodas4(dynamics::Dynamics& dynamics, const Goal& goal)
    : Integrator(dynamics),
      control_(dynamics, goal,
               {.estimate = 4.0,
                .method = 4.0,
                .constant = kConstant,
                .contact_change = kContactChange,
                .kink = kKink,
                .has_quintic_outputs = true},
               LocalErrorControl::Steps::geometric),
      solver_(dynamics.effective(), dynamics.obstacles()) {
  if (dynamics.obstacles() != nullptr && dynamics::has_infinite_slope(*dynamics.obstacles()))
    throw InputError(
        "integrator.type: rodas4 takes derivatives of forces, and that of the contact's dissipation is infinite where "
        "the contact closes");
  for (std::size_t i = 0; i < kStages; ++i) p_[i] = q_[i] = Vector::Zero(dynamics.size());
  work_ = other_ = residual_v_ = rate_ = Vector::Zero(dynamics.size());
  stop_displacement_ = stop_force_ = tangent_ = stop_work_ = Vector::Zero(dynamics.stop_count());
}

void Rodas4::do_start(time::State& state) {
  state.memory.resize(LocalErrorControl::memory_size(state.x.size()));
  control_.start(state);
}

void Rodas4::tangent_force(ConstVectorRef y) {
  dynamics().elastic_force(y, work_);
  solver_.add_stiffness(dynamics().stops(), y, stop_work_, work_);
}

time::StepReport Rodas4::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h, d = kGamma * h;
  dynamics().set_time(from.t);
  if (dynamics().stop_count() > 0) {
    dynamics().stops().displacement(from.x, stop_displacement_);
    dynamics().stops().tangent(stop_displacement_, stop_force_, tangent_);
  }
  dynamics().external_force_rate(from.t, 1e-3 * h, rate_);
  dynamics().subtract_matrix_rate(from.x, from.v, rate_);
  if (dynamics::Obstacles* all = dynamics().obstacles()) {
    obstacles_ = all->tangents(from.t, from.x, from.v);
    for (const dynamics::Obstacles::Tangent& tangent : obstacles_) all->scatter(tangent.contact, tangent.rate, rate_);
  }
  time::StepReport report;
  if (!solver_.set(d, d * d, tangent_, obstacles_)) {
    report.status = time::StepStatus::singular;
    return report;
  }
  for (std::size_t i = 0; i < kStages; ++i) {
    x_ = from.x;
    v_ = from.v;
    for (std::size_t j = 0; j < i; ++j) {
      x_ += kA[i][j] * p_[j];
      v_ += kA[i][j] * q_[j];
    }
    residual_x_ = v_;
    other_.setZero();
    for (std::size_t j = 0; j < i; ++j) {
      residual_x_ += (kC[i][j] / h) * p_[j];
      other_ += (kC[i][j] / h) * q_[j];
    }
    dynamics().total_force(from.t, kTimes[i] * h, x_, v_, residual_v_);
    dynamics().set_time(from.t);
    if (i > 0) {
      dynamics().inertia_force(other_, work_);
      residual_v_ += work_;
    }
    if (kRates[i] != 0.0) residual_v_ += (kRates[i] * h) * rate_;
    tangent_force(residual_x_);
    q_[i] = d * (residual_v_ - d * work_);
    if (!solver_.solve(q_[i])) {
      report.status = std::isfinite(q_[i].sum()) ? time::StepStatus::singular : time::StepStatus::not_finite;
      return report;
    }
    p_[i] = d * (residual_x_ + q_[i]);
  }
  to.x = x_ + p_.back();
  to.v = v_ + q_.back();
  to.a = from.a;  // A step that will be repeated needs no evaluation at its end.
  control_.judge(from, to, h, p_.back(), q_.back(), report);
  if (report.error <= 1.0 && report.status == time::StepStatus::ok)
    dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  output_.accept(from.t, to.t, control_.is_long(h), p_, q_);
  return report;
}

time::IntegratorType rodas4_type() {
  return {.name = "rodas4",
          .aliases = {"RODAS"},
          .summary = "Rosenbrock method of order 4(3), one matrix and six solves a step, steps by the local error",
          .parameters = {LocalErrorControl::parameter(1e-4, 1e-10)},
          .order = 4.0,
          .finds_first_step = true,
          .contacts = time::ContactSupport::without_rigid,
          .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Rodas4>(dynamics, Goal::read(p));
          }};
}

}  // namespace butee::integrators

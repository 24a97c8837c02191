#include "integrators/rodas4.hpp"

#include <cmath>

#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

/// Calibrated in tests/stress.
constexpr double kKink = 10.0;
constexpr double kGamma = 0.25;
/// c, where the stages take the load, and gamma_i.
constexpr std::array<double, 6> kTimes = {0.0, 0.386, 0.21, 0.63, 1.0, 1.0};
constexpr std::array<double, 6> kRates = {0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0};
constexpr double kA[6][5] = {{},
                             {1.544},
                             {0.9466785280815826, 0.2557011698983284},
                             {3.314825187068521, 2.896124015972201, 0.9986419139977817},
                             {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
                             {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0}};
constexpr double kC[6][5] = {
    {},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}};

}  // namespace

Rodas4::Rodas4(solve::Dynamics& dynamics, double tolerance)
    : Integrator(dynamics), control_(dynamics, tolerance, {4.0, 4.0, 1.0, kKink}, LocalErrorControl::Steps::ladder) {
  for (std::size_t i = 0; i < kStages; ++i) p_[i] = q_[i] = Vector::Zero(dynamics.size());
  work_ = other_ = residual_v_ = rate_ = Vector::Zero(dynamics.size());
  stop_displacement_ = stop_force_ = tangent_ = stop_work_ = Vector::Zero(dynamics.stop_count());
}

void Rodas4::do_start(time::State& state) {
  state.memory.resize(LocalErrorControl::kMemory);
  control_.start(state);
}

void Rodas4::tangent_force(ConstVectorRef y) {
  dynamics().elastic_force(y, work_);
  if (dynamics().stop_count() == 0) return;
  dynamics().contact().displacement(y, stop_work_);
  stop_work_.array() *= tangent_.array();
  dynamics().contact().scatter(stop_work_, work_);
}

time::StepReport Rodas4::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h, d = kGamma * h;
  solve::EffectiveSolver& effective = dynamics().effective();
  effective.set_factors(d, d * d);
  if (dynamics().stop_count() > 0) {
    dynamics().contact().displacement(from.x, stop_displacement_);
    dynamics().contact().tangent(stop_displacement_, stop_force_, tangent_);
  }
  dynamics().external_force_rate(from.t, 1e-3 * h, rate_);
  time::StepReport report;
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
    dynamics().total_force(from.t + kTimes[i] * h, x_, v_, residual_v_);
    if (i > 0) {
      dynamics().inertia_force(other_, work_);
      residual_v_ += work_;
    }
    if (kRates[i] != 0.0) residual_v_ += (kRates[i] * h) * rate_;
    tangent_force(residual_x_);
    q_[i] = d * (residual_v_ - d * work_);
    if (!effective.solve(tangent_, q_[i])) {
      report.status = std::isfinite(q_[i].sum()) ? time::StepStatus::singular : time::StepStatus::not_finite;
      return report;
    }
    p_[i] = d * (residual_x_ + q_[i]);
  }
  to.x = x_ + p_.back();
  to.v = v_ + q_.back();
  to.a = from.a;  // Where the step is going to be redone no evaluation is spent on its end.
  control_.judge(from, to, h, p_.back(), q_.back(), report);
  if (report.error <= 1.0 && report.status == time::StepStatus::ok)
    dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  return report;
}

time::IntegratorType rodas4_type() {
  return {.name = "rodas4",
          .aliases = {"RODAS"},
          .summary = "Rosenbrock method of order 4(3), one matrix and six solves a step, steps by the local error",
          .parameters = {LocalErrorControl::parameter(1e-4)},
          .order = 4.0,
          .finds_first_step = true,
          .make = [](const config::Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Rodas4>(dynamics, p.number("tolerance"));
          }};
}

}  // namespace butee::integrators

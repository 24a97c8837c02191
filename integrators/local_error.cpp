#include "integrators/local_error.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 5.0;
/// The exponents of r and r_old, times 1/q.
constexpr double kProportional = 0.7, kIntegral = 0.4;
/// r_old is taken for no better than this.
constexpr double kSmallest = 1e-4;
/// Steps of the ladder within a factor of two; one is gone up where the estimate would allow for kReserve.
constexpr double kRungs = 4.0;
constexpr double kReserve = 3.0;
/// The part of what a jump of the force makes in a step that its speed may be wrong by.
constexpr double kOfJump = 0.1;
/// The error of a step that went through a stop unseen: enough to be redone, by a ladder with about half its length.
constexpr double kMissed = 8.0;
constexpr double kMostDown = 9.0, kMostUp = 9.0;

/// The highest k/m of a single DOF, 1/s^2.
double highest(const Vector& stiffness, const Vector& mass) {
  double square = 0.0;
  for (Index i = 0; i < mass.size(); ++i)
    if (stiffness[i] > 0.0) square = std::max(square, stiffness[i] / mass[i]);
  return square;
}

}  // namespace

LocalErrorControl::LocalErrorControl(solve::Dynamics& dynamics, double tolerance, Orders orders, Steps steps)
    : dynamics_(dynamics),
      contact_(dynamics, tolerance),
      threshold_(orders.share * std::pow(tolerance, orders.estimate / orders.method)),
      estimate_order_(orders.estimate),
      kink_(orders.kink),
      stability_(orders.stability),
      steps_(steps),
      work_(dynamics.size()) {
  const model::System& system = dynamics.system();
  Vector stiffness = system.stiffness.diagonal();
  const Vector mass = system.mass.diagonal();
  const double square = highest(stiffness, mass);
  first_step_ = square > 0.0 ? 0.1 / std::sqrt(square) : 1e-6;
  const solve::Contact& contact = dynamics.contact();
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)})
      if (dof >= 0) stiffness[dof] += closed[i];
  omega_ = std::sqrt(highest(stiffness, mass));
}

double LocalErrorControl::norm(ConstVectorRef y) {
  dynamics_.inertia_force(y, work_);
  return std::sqrt(std::max(0.0, y.dot(work_)));
}

void LocalErrorControl::start(time::State& state) {
  state.memory.head(kMemory) << norm(state.x), norm(state.v), 1.0;
}

double LocalErrorControl::relative_error(const time::State& from, const time::State& to, double error_x, double error_v,
                                         double scale_x, double scale_v) {
  const auto relative = [](double error, double scale) { return error > 0.0 ? error / scale : 0.0; };
  const double r = std::max(relative(error_x, scale_x), relative(error_v, scale_v));
  if (!(r > threshold_) || omega_ == 0.0) return r;
  const double v = std::max(norm(from.a), norm(to.a)) / omega_;
  return std::max(relative(error_x, std::max(scale_x, v / omega_)), relative(error_v, std::max(scale_v, v)));
}

void LocalErrorControl::judge(const time::State& from, time::State& to, double h, ConstVectorRef error_x,
                              ConstVectorRef error_v, time::StepReport& report) {
  const double scale_x = std::max(from.memory[0], norm(to.x)), scale_v = std::max(from.memory[1], norm(to.v));
  double r = relative_error(from, to, norm(error_x), norm(error_v), scale_x, scale_v) / threshold_;
  if (kink_ > 1.0 && r <= 1.0 && contact_.changed(from, to)) r *= kink_;
  if (const double jump = r <= 1.0 ? contact_.jump(from, to) : 0.0; jump > 0.0)
    r = std::max(r, kOfJump * h * jump / (threshold_ * std::max(scale_v, std::max(norm(from.a), norm(to.a)) / omega_)));
  to.memory.head(kMemory) << scale_x, scale_v, std::max(r, kSmallest);
  if (!std::isfinite(r)) {
    report.status = time::StepStatus::not_finite;
    return;
  }
  const bool is_unstable = r <= 1.0 && h * omega_ > stability_ && contact_.changed(from, to);
  if (r <= 1.0 && (is_unstable || contact_.was_missed(from, to, h))) {
    report.error = kMissed;
    report.proposal = steps_ == Steps::any ? 0.5 * h : ladder_step(h, kMissed);
    return;
  }
  report.error = r;
  report.proposal = steps_ == Steps::any ? any_step(h, r, from.memory[2]) : ladder_step(h, r);
}

double LocalErrorControl::any_step(double h, double r, double old) const {
  const double q = estimate_order_, careful = std::max(r, kSmallest);
  if (r > 1.0) return h * std::clamp(kSafety * std::pow(careful, -1.0 / q), kLeast, kSafety);
  return h * std::clamp(kSafety * std::pow(careful, -kProportional / q) * std::pow(old, kIntegral / q), kLeast, kMost);
}

double LocalErrorControl::ladder_step(double h, double r) const {
  const double rungs = std::log2(kSafety / std::max(r, kSmallest)) * kRungs / estimate_order_;
  if (r <= 1.0 && rungs < kReserve) return h;
  const double rung =
      kRungs * std::log2(h) + std::clamp(rungs - (r <= 1.0 ? kReserve - 1.0 : 0.0), -kMostDown, kMostUp);
  return std::exp2(std::floor(rung + 1e-6) / kRungs);
}

config::Parameter LocalErrorControl::parameter(double fallback) {
  return config::number("tolerance", "1", "relative error aimed at, in displacements and velocities")
      .above(0)
      .at_most(0.1)
      .or_else(fallback)
      .sweep(1e-1, 1e-9);
}

}  // namespace butee::integrators

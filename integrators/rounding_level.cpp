#include "integrators/rounding_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "integrators/magnitudes.hpp"

namespace butee::integrators {
namespace {

/// Errors below this part of the motion of the whole structure, in the norm of the diagonal of M, are rounding.
constexpr double kRoundingOfMotion = 1e-14;
/// But rounding of a component is at most this multiple of the same part of what it has and what the forces on it cause
/// within its own period: a light part does not share the rounding of heavy ones.
constexpr double kOfForces = 10.0;
/// Errors of a step below this part of a component, or of what the forces on it cause in the step, are rounding.
constexpr double kRoundingOfStep = 1e-15;
/// Errors of that size are rounding in steps below this part of the longest stable one; in longer ones they may be the
/// growth at the limit of stability.
constexpr double kShortStep = 0.5;

}  // namespace

RoundingLevel::RoundingLevel(dynamics::Dynamics& dynamics, double tolerance, double rate)
    : dynamics_(dynamics),
      of_motion_(kRoundingOfMotion / tolerance),
      rate_(rate),
      is_lumped_(dynamics.system().mass.nonZeros() == dynamics.size()),
      root_mass_(dynamics.system().mass.diagonal().cwiseSqrt()),
      stop_stiffness_(dynamics.stops().closed_stiffness()),
      w0_(Vector::Zero(stop_stiffness_.size())),
      w1_(w0_) {
  const model::System& system = dynamics.system();
  const Vector mass = root_mass_.cwiseAbs2();
  Vector stiffness = system.stiffness.diagonal(),
         damping = system.damping.mass_proportional * mass + system.damping.stiffness_proportional * stiffness;
  if (system.dashpots.size() > 0) damping += system.dashpots.diagonal();
  own_square_ = stiffness.cwiseMax(0.0).cwiseQuotient(mass);
  own_rate_ = own_square_.cwiseSqrt().cwiseMax(damping.cwiseQuotient(mass));
}

void RoundingLevel::raise(const time::State& from, const time::State& to, double h, double stable, double bound,
                          Vector& scale_x, Vector& scale_v) {
  const double of_x = of_motion_ * root_mass_.cwiseProduct(scale_x).norm(),
               of_v = of_motion_ * root_mass_.cwiseProduct(scale_v).norm();
  sum_forces(from, to);
  // force_ := the accelerations; a mass matrix that couples DOFs spreads their rounding.
  if (is_lumped_)
    force_ = force_.cwiseQuotient(root_mass_.cwiseAbs2());
  else
    force_ = root_mass_.cwiseInverse() * force_.cwiseQuotient(root_mass_).norm();
  const auto within = [](double a, double rate) {
    return rate > 0.0 ? a / rate : std::numeric_limits<double>::infinity();
  };
  most_x_ = kOfForces * of_motion_ * (scale_x + force_.binaryExpr(own_square_, within));
  most_v_ = kOfForces * of_motion_ * (scale_v + force_.binaryExpr(own_rate_, within));
  if (h < kShortStep * stable) {
    // In longer steps of an implicit method the elastic forces that follow take up those of rounding.
    const double time = rate_ > 0.0 ? std::min(h, 1.0 / rate_) : h;
    const double part = kRoundingOfStep / bound;
    scale_x = scale_x.cwiseMax(part * (scale_x + h * scale_v + (time * time) * force_));
    scale_v = scale_v.cwiseMax(part * (scale_v + time * force_));
  }
  scale_x = scale_x.cwiseMax((of_x * root_mass_.cwiseInverse()).cwiseMin(most_x_));
  scale_v = scale_v.cwiseMax((of_v * root_mass_.cwiseInverse()).cwiseMin(most_v_));
}

void RoundingLevel::sum_forces(const time::State& from, const time::State& to) {
  const model::System& system = dynamics_.system();
  x_ = from.x.cwiseAbs().cwiseMax(to.x.cwiseAbs());
  v_ = from.v.cwiseAbs().cwiseMax(to.v.cwiseAbs());
  force_ = system.damping.mass_proportional * root_mass_.cwiseAbs2().cwiseProduct(v_);
  add_magnitudes(system.stiffness, 1.0, x_, force_);
  add_magnitudes(system.stiffness, system.damping.stiffness_proportional, v_, force_);
  add_magnitudes(system.dashpots, 1.0, v_, force_);
  for (const model::FreeLoad& load : system.loads) {
    const double value = std::max(std::abs(load.in_time->value(from.t)), std::abs(load.in_time->value(to.t)));
    for (std::size_t i = 0; i < load.dofs.size(); ++i) force_[load.dofs[i]] += std::abs(load.weights[i]) * value;
  }
  add_contacts(from, to);
}

void RoundingLevel::add_contacts(const time::State& from, const time::State& to) {
  const auto add = [&](double stiffness, std::span<const Index> dofs) {
    double size = 0.0;
    for (const Index dof : dofs)
      if (dof >= 0) size += x_[dof];
    for (const Index dof : dofs)
      if (dof >= 0) force_[dof] += stiffness * size;
  };
  const dynamics::ElasticStops& stops = dynamics_.stops();
  stops.displacement(from.x, w0_);
  stops.displacement(to.x, w1_);
  for (Index i = 0; i < stops.size(); ++i) {
    const model::FreePlay& play = stops.play_of(i);
    if (play.closed_side(w0_[i]) != 0.0 || play.closed_side(w1_[i]) != 0.0)
      add(stop_stiffness_[i], std::array{stops.dof_a(i), stops.dof_b(i)});
  }
  const dynamics::Obstacles* const obstacles = dynamics_.obstacles();
  if (obstacles == nullptr) return;
  for (Index i = 0; i < obstacles->size(); ++i) {
    if (!obstacles->phase(i).touches()) continue;
    const auto& ends = obstacles->ends_of(i);
    add(obstacles->closed_stiffness(i), std::array{ends.a[0], ends.a[1], ends.b[0], ends.b[1]});
  }
}

}  // namespace butee::integrators

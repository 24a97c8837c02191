#include "integrators/fastest_rates.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

/// The largest k/m of a single DOF, 1/s^2.
double highest(const Vector& stiffness, const Vector& mass) {
  double square = 0.0;
  for (Index i = 0; i < mass.size(); ++i)
    if (stiffness[i] > 0.0) square = std::max(square, stiffness[i] / mass[i]);
  return square;
}

/// The highest rate at which damping decelerates a single DOF, 1/s.
double damping_rate(const model::System& system, const Vector& stiffness, const Vector& mass) {
  double rate = 0.0;
  for (Index i = 0; i < mass.size(); ++i) {
    const double dashpot = system.dashpots.size() > 0 ? system.dashpots.coeff(i, i) : 0.0;
    rate = std::max(rate, system.damping.mass_proportional +
                              (system.damping.stiffness_proportional * stiffness[i] + dashpot) / mass[i]);
  }
  return rate;
}

/// The highest rate at which friction supports decelerate a single DOF in the steep part of their
/// friction law, 1/s.
double friction_rate(const dynamics::Obstacles* obstacles, const Vector& mass) {
  double rate = 0.0;
  if (obstacles == nullptr) return rate;
  for (Index i = 0; i < obstacles->size(); ++i) {
    const model::ObstacleGroup& group = obstacles->group_of(i);
    if (group.shape != nullptr || !(group.friction.slip_speed > 0.0)) continue;
    const double damping = group.friction.coefficient * group.normal_force / group.friction.slip_speed;
    for (const Index dof : {obstacles->ends_of(i).a[0], obstacles->ends_of(i).b[0]})
      if (dof >= 0) rate = std::max(rate, damping / mass[dof]);
  }
  return rate;
}

}  // namespace

FastestRates fastest_rates(dynamics::Dynamics& dynamics) {
  const model::System& system = dynamics.system();
  const Vector mass = system.mass.diagonal();
  Vector stiffness = system.stiffness.diagonal();
  FastestRates rates;
  rates.open = std::sqrt(highest(stiffness, mass));
  rates.damping = damping_rate(system, stiffness, mass);
  const dynamics::ElasticStops& stops = dynamics.stops();
  const Vector closed = stops.closed_stiffness();
  for (Index i = 0; i < stops.size(); ++i)
    for (const Index dof : {stops.dof_a(i), stops.dof_b(i)})
      if (dof >= 0) stiffness[dof] += closed[i];
  const dynamics::Obstacles* const obstacles = dynamics.obstacles();
  if (obstacles != nullptr)
    for (Index i = 0; i < obstacles->size(); ++i)
      for (const auto& ends : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : {ends[0], ends[1]})
          if (dof >= 0) stiffness[dof] += obstacles->closed_stiffness(i);
  rates.friction = friction_rate(obstacles, mass);
  rates.closed = std::max(std::sqrt(highest(stiffness, mass)), rates.friction);
  return rates;
}

double bound_of_damping(const model::System& system) {
  const Vector mass = system.mass.diagonal();
  Vector sums = Vector::Constant(mass.size(), system.damping.mass_proportional);
  const auto add = [&](const SparseMatrix& matrix, double factor) {
    for (Index j = 0; factor != 0.0 && j < matrix.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
        sums[entry.row()] += factor * std::abs(entry.value()) / std::sqrt(mass[entry.row()] * mass[j]);
  };
  add(system.stiffness, system.damping.stiffness_proportional);
  add(system.dashpots, 1.0);
  return sums.maxCoeff();
}

}  // namespace butee::integrators

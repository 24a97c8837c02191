#include "butee/time/contact_switches.hpp"

#include <algorithm>
#include <numeric>

#include "butee/time/derivative_rounding.hpp"

namespace butee::time {
namespace {

/// The uncertainty of displacements and velocities relative to those of the whole structure in the norm of the diagonal
/// of M, since sums over modes cancel to about this (chosen: 18 eps).
constexpr double kRoundingOfModes = 4e-15;

/// Replaces a derivative of the displacement within a step by the line through both ends if it changes less over the
/// step than the rounding of an interpolant.
double without_rounding(double interpolated, double from, double to, double place, double rounding) {
  return std::abs(to - from) < rounding ? from + place * (to - from) : interpolated;
}

}  // namespace

ContactSwitches::ContactSwitches(dynamics::Dynamics& dynamics, double velocity_uncertainty)
    : dynamics_(dynamics),
      obstacles_(*dynamics.obstacles()),
      all_(static_cast<std::size_t>(dynamics.size())),
      velocity_uncertainty_(velocity_uncertainty) {
  std::iota(all_.begin(), all_.end(), Index{0});
  values_x_.resize(all_.size());
  values_v_ = values_x_;
  root_mass_ = dynamics.system().mass.diagonal().cwiseSqrt();
  for (Index i = 0; i < obstacles_.size(); ++i) {
    double share = 0.0;
    for (const auto& side : {obstacles_.ends_of(i).a, obstacles_.ends_of(i).b})
      for (const Index dof : {side[0], side[1]})
        if (dof >= 0) share += kRoundingOfModes / root_mass_[dof];
    rounding_shares_.push_back(share);
    needs_accelerations_ = needs_accelerations_ || obstacles_.switches_by_acceleration(i);
    const model::ObstacleGroup& group = obstacles_.group_of(i);
    needs_velocities_ = needs_velocities_ || needs_accelerations_ ||
                        group.friction.rule != model::Friction::Rule::none ||
                        group.damping.kind != model::ImpactDamping::Kind::none;
  }
  if (needs_accelerations_) values_a_ = values_x_;
}

ContactSwitches::Sample ContactSwitches::room() const {
  Sample sample;
  sample.x = sample.v = sample.a = Vector::Zero(dynamics_.size());
  return sample;
}

void ContactSwitches::measure(const State& state) {
  whole_ = {root_mass_.cwiseProduct(state.x).norm(), root_mass_.cwiseProduct(state.v).norm()};
}

void ContactSwitches::hold(Sample& at) {
  update_sticks();
  if (!sticks_.empty()) at.held = dynamics_.stick_forces(at.t, at.x, at.v);
}

void ContactSwitches::take(const State& state, Sample& at) {
  at.t = state.t;
  at.x = state.x;
  at.v = state.v;
  if (needs_accelerations_) at.a = state.a;
  hold(at);
}

void ContactSwitches::look_ahead(const State& state, double ahead, Sample& at) {
  at.t = state.t + ahead;
  at.x.noalias() = state.x + ahead * (state.v + 0.5 * ahead * state.a);
  at.v.noalias() = state.v + ahead * state.a;
  if (needs_accelerations_) dynamics_.acceleration(at.t, at.x, at.v, at.a);
  hold(at);
}

void ContactSwitches::interpolate(const DenseOutput& motion, double t, const std::vector<Index>& dofs, Sample& at) {
  at.t = t;
  const State& to = motion.to();
  if (t >= to.t) {
    at.x = to.x;
    at.v = to.v;
    if (needs_accelerations_) at.a = to.a;
  } else {
    const std::vector<Index>& used = sticks_.empty() ? dofs : all_;
    const std::span<double> x(values_x_.data(), used.size()), v(values_v_.data(), needs_velocities_ ? used.size() : 0);
    motion.trace(t, used, {x, v, {}});
    const std::span<double> a(values_a_.data(), needs_accelerations_ ? used.size() : 0);
    if (!a.empty()) motion.interpolate(t, used, {{}, {}, a});
    const State& from = motion.from();
    const double h = to.t - from.t, place = (t - from.t) / h;
    for (std::size_t k = 0; k < used.size(); ++k) at.x[used[k]] = x[k];
    for (std::size_t k = 0; k < v.size(); ++k) {
      const Index dof = used[k];
      const double displacement = std::max(std::abs(from.x[dof]), std::abs(to.x[dof])),
                   speed = std::max(std::abs(from.v[dof]), std::abs(to.v[dof]));
      const auto settle = [&](int order, double value, double begin, double end) {
        return without_rounding(value, begin, end, place, derivative_rounding(order, displacement, speed, to.t, h));
      };
      at.v[dof] = settle(1, v[k], from.v[dof], to.v[dof]);
      if (!a.empty()) at.a[dof] = settle(2, a[k], from.a[dof], to.a[dof]);
    }
  }
  if (!sticks_.empty()) hold(at);
}

std::span<const ContactSwitches::Switch> ContactSwitches::of(Index contact, const Sample& at) {
  double held = 0.0;
  if (const auto place = std::find(sticks_.begin(), sticks_.end(), contact); place != sticks_.end())
    held = -at.held[place - sticks_.begin()];
  const double share = rounding_shares_[static_cast<std::size_t>(contact)];
  const std::size_t count =
      obstacles_.switches(contact, at.t, at.x, at.v, at.a, held,
                          {share * whole_.displacement, share * whole_.velocity, velocity_uncertainty_}, found_);
  return {found_.data(), count};
}

}  // namespace butee::time

#include "butee/dynamics/external_forces.hpp"

#include <algorithm>
#include <cmath>

namespace butee::dynamics {
namespace {

/// Relative change of a load over the rounding of t that is a jump. At a corner where a steep load returns to 0 any
/// change is large relative to the load, but it is no more than kCorner times that over the same time before.
constexpr double kJump = 1e-3, kCorner = 10.0;

/// True if a load is a parabola over less than kFew spacings of the doubles at t: rounding of t changes it by more than
/// 1/kFew.
bool is_steep(const model::TimeFunction& load) {
  constexpr double kFew = 1e8;
  if (!load.is_piecewise_parabolic()) return false;
  const std::vector<double> instants = load.discontinuities();
  for (std::size_t i = 1; i < instants.size(); ++i)
    if (instants[i] - instants[i - 1] < kFew * std::numeric_limits<double>::epsilon() * instants[i]) return true;
  return false;
}

}  // namespace

ExternalForces::ExternalForces(const model::System& system)
    : system_(system), values_(system.loads.size()), is_steep_(system.loads.size()) {
  for (std::size_t j = 0; j < system.loads.size(); ++j)
    for (std::size_t i = 0; i < system.loads[j].dofs.size(); ++i)
      entries_.push_back({system.loads[j].dofs[i], system.loads[j].weights[i], j});
  replaced();
}

void ExternalForces::replaced() {
  changed();
  for (std::size_t i = 0; i < is_steep_.size(); ++i) is_steep_[i] = is_steep(*system_.loads[i].in_time) ? 1 : 0;
}

void ExternalForces::evaluate(double t, double after) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const model::TimeFunction& load = *system_.loads[i].in_time;
    if (after != 0.0 && is_steep_[i] != 0 && load.taylor(t, 1.0, series_))
      values_[i] = series_[0] + after * (series_[1] + after * series_[2]);
    else
      values_[i] = load.value(t + after);
  }
  time_ = t;
  after_ = after;
}

void ExternalForces::rate(double t, double h, VectorRef rate) {
  rate.setZero();
  for (const model::FreeLoad& load : system_.loads) {
    double slope = 0.0;
    if (load.in_time->taylor(t, 1.0, series_))
      slope = series_[1];
    else
      slope = (load.in_time->value(t + h) - load.in_time->value(t)) / h;
    for (std::size_t i = 0; i < load.dofs.size(); ++i) rate[load.dofs[i]] += load.weights[i] * slope;
  }
}

std::vector<double> ExternalForces::discontinuities() const {
  std::vector<double> all;
  const auto take = [&all](const std::vector<double>& instants) {
    all.insert(all.end(), instants.begin(), instants.end());
  };
  for (const model::FreeLoad& load : system_.loads) take(load.in_time->discontinuities());
  if (const model::Rotation* rotation = varying_rotation()) take(rotation->discontinuities());
  std::sort(all.begin(), all.end());
  return all;
}

bool ExternalForces::jump_at(double t) const {
  if (!(t > 0.0)) return false;
  for (std::size_t i = 0; i < is_steep_.size(); ++i) {
    if (is_steep_[i] != 0) continue;
    const model::TimeFunction& load = *system_.loads[i].in_time;
    const double earlier = load.value(just_before(just_before(t))), before = load.value(just_before(t)),
                 after = load.value(t), change = std::abs(after - before);
    if (change > kJump * std::max(std::abs(after), std::abs(before)) && change > kCorner * std::abs(before - earlier))
      return true;
  }
  const model::Rotation* const rotation = varying_rotation();
  return rotation != nullptr && rotation->acceleration(just_before(t)) != rotation->acceleration(t);
}

const model::Rotation* ExternalForces::varying_rotation() const {
  if (system_.rotation != nullptr || system_.model == nullptr) return system_.rotation;
  const model::Rotation* const rotation = system_.model->rotation.get();
  if (rotation == nullptr || rotation->is_constant()) return nullptr;
  const bool rubs = std::any_of(system_.obstacles.begin(), system_.obstacles.end(),
                                [](const model::FreeObstacles& obstacles) { return obstacles.group->turning != 0.0; });
  return rubs ? rotation : nullptr;
}

}  // namespace butee::dynamics

#include "trajectory.hpp"

#include <algorithm>
#include <limits>

namespace butee::stress {

Follower::Follower(Index size, const std::vector<double>& instants)
    : trajectory(size, instants.size()), instants_(instants) {
  for (Index i = 0; i < size; ++i) all_.push_back(i);
}

void Follower::start(const time::State& state) {
  if (trajectory.rows > 0 || instants_.empty() || instants_.front() > state.t) return;
  trajectory.x.col(0) = state.x;
  trajectory.v.col(0) = state.v;
  trajectory.rows = 1;
}

void Follower::step(const time::AcceptedStep& step) {
  largest = std::max(largest, step.to.x.lpNorm<Eigen::Infinity>());
  Trajectory& to = trajectory;
  to.is_finite = to.is_finite && step.to.x.allFinite() && step.to.v.allFinite() && step.to.a.allFinite();
  for (; to.rows < to.x.cols(); ++to.rows) {
    const double t = instants_[static_cast<std::size_t>(to.rows)];
    if (t > step.to.t) break;
    const auto size = static_cast<std::size_t>(to.x.rows());
    step.motion.interpolate(t, all_, {{to.x.col(to.rows).data(), size}, {to.v.col(to.rows).data(), size}, {}});
    to.is_finite = to.is_finite && to.x.col(to.rows).allFinite() && to.v.col(to.rows).allFinite();
  }
}

double Follower::next_instant(double t) const {
  const auto next = std::upper_bound(instants_.begin(), instants_.end(), t);
  return next == instants_.end() ? std::numeric_limits<double>::infinity() : *next;
}

}  // namespace butee::stress

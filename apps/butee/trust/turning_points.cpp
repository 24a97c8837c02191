#include "turning_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace butee::app::trust {
namespace {

/// Largest angle of the fastest mode between two samples, rad, and the limits of the number of samples.
constexpr double kAngle = 0.5;
constexpr double kFewest = 3.0, kMost = 64.0;
/// Largest number of iterations and tolerance of the search for an instant of zero velocity.
constexpr int kMostTrials = 12;
constexpr double kAtRest = 1e-9;

}  // namespace

TurningPoints::TurningPoints(std::vector<Path> paths, double omega) : paths_(std::move(paths)), omega_(omega) {
  for (const Path& path : paths_)
    for (const Index dof : {path.a, path.b})
      if (dof >= 0) dofs_.push_back(dof);
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  if (!dofs_.empty()) slots_.resize(static_cast<std::size_t>(dofs_.back()) + 1, 0);
  for (std::size_t i = 0; i < dofs_.size(); ++i) slots_[static_cast<std::size_t>(dofs_[i])] = static_cast<Index>(i);
}

void TurningPoints::start(const time::State& state) {
  for (Path& path : paths_) {
    path.least = path.greatest = (path.a >= 0 ? state.x[path.a] : 0.0) - (path.b >= 0 ? state.x[path.b] : 0.0);
  }
}

void TurningPoints::step(const time::AcceptedStep& step) {
  if (dofs_.empty()) return;
  double begin = step.from.t;
  for (const double breakpoint : step.motion.breakpoints()) {
    sample(step, begin, breakpoint);
    begin = breakpoint;
  }
  sample(step, begin, step.to.t);
}

void TurningPoints::sample(const time::AcceptedStep& step, double begin, double end) {
  if (!(end > begin)) return;
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil((end - begin) * omega_ / kAngle), kFewest, kMost));
  times_.clear();
  for (std::size_t i = 0; i < count; ++i)
    times_.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(count));
  times_.push_back(end);
  x_.resize(times_.size() * dofs_.size());
  v_.resize(times_.size() * dofs_.size());
  step.motion.interpolate(times_, dofs_, {x_, v_, {}});
  for (Path& path : paths_) {
    Motion before = at(path, 0);
    for (std::size_t i = 1; i < times_.size(); ++i) {
      const Motion now = at(path, i);
      path.least = std::min(path.least, now.x);
      path.greatest = std::max(path.greatest, now.x);
      if (before.v * now.v < 0.0) turn(path, step, times_[i - 1], times_[i], before, now);
      before = now;
    }
  }
}

void TurningPoints::turn(Path& path, const time::AcceptedStep& step, double begin, double end, Motion from,
                         Motion to) const {
  const double moves = (end - begin) * std::max(std::abs(from.v), std::abs(to.v));
  if (std::max(from.x, to.x) + moves <= path.greatest && std::min(from.x, to.x) - moves >= path.least) return;
  const double fast = std::max(std::abs(from.v), std::abs(to.v));
  // False position with the Illinois modification: the function value at a retained end is halved.
  double v0 = from.v, v1 = to.v;
  int stayed = 0;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    const double t = begin + (end - begin) * v0 / (v0 - v1);
    if (!(t > begin && t < end)) return;
    const Motion now = motion(path, step, t);
    path.least = std::min(path.least, now.x);
    path.greatest = std::max(path.greatest, now.x);
    if (std::abs(now.v) <= kAtRest * fast) return;
    if (now.v * v0 > 0.0) {
      begin = t;
      v0 = now.v;
      if (stayed == 1) v1 *= 0.5;
      stayed = 1;
    } else {
      end = t;
      v1 = now.v;
      if (stayed == -1) v0 *= 0.5;
      stayed = -1;
    }
  }
}

TurningPoints::Motion TurningPoints::at(const Path& path, std::size_t instant) const {
  const std::size_t row = instant * dofs_.size();
  Motion motion{0.0, 0.0};
  for (const auto& [dof, sign] : {std::pair(path.a, 1.0), std::pair(path.b, -1.0)}) {
    if (dof < 0) continue;
    const auto slot = row + static_cast<std::size_t>(slots_[static_cast<std::size_t>(dof)]);
    motion.x += sign * x_[slot];
    motion.v += sign * v_[slot];
  }
  return motion;
}

TurningPoints::Motion TurningPoints::motion(const Path& path, const time::AcceptedStep& step, double t) const {
  Motion motion{0.0, 0.0};
  for (const auto& [dof, sign] : {std::pair(path.a, 1.0), std::pair(path.b, -1.0)}) {
    if (dof < 0) continue;
    std::array<double, 1> x{}, v{};
    step.motion.interpolate(t, std::array{dof}, {x, v, {}});
    motion.x += sign * x[0];
    motion.v += sign * v[0];
  }
  return motion;
}

}  // namespace butee::app::trust

#include "butee/study/steady.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace butee::study {
namespace {

/// Differences below this fraction of a state are rounding.
constexpr double kRounding = 1e-13;

}  // namespace

SteadyWatch::SteadyWatch(dynamics::Dynamics& dynamics, double period, double tolerance)
    : dynamics_(dynamics),
      period_(period),
      tolerance_(tolerance),
      sections_(static_cast<std::size_t>(kKept)),
      dofs_(static_cast<std::size_t>(dynamics.size())) {
  std::iota(dofs_.begin(), dofs_.end(), Index{0});
  for (const double t : dynamics.load_discontinuities()) earliest_ = std::max(earliest_, t);
}

double SteadyWatch::size_of(const Vector& x, const Vector& v) const {
  const double omega = 2.0 * std::numbers::pi / period_;
  const SparseMatrix& mass = dynamics_.system().mass;
  return std::sqrt(std::max(0.0, v.dot(mass * v) + omega * omega * x.dot(mass * x)));
}

void SteadyWatch::step(const time::AcceptedStep& step) {
  if (!is_open_) return;
  for (double t = static_cast<double>(taken_ + 1) * period_; t <= step.to.t && repeats_ == 0;
       t = static_cast<double>(taken_ + 1) * period_) {
    Section& section = sections_[static_cast<std::size_t>(++taken_ % kKept)];
    section.x.resize(dynamics_.size());
    section.v.resize(dynamics_.size());
    step.motion.interpolate(t, dofs_, {{section.x.data(), dofs_.size()}, {section.v.data(), dofs_.size()}, {}});
    if (taken_ >= kKept && taken_ % kBetweenLooks == 0 && t > earliest_) look();
  }
}

void SteadyWatch::look() {
  const double size = size_of(section(taken_).x, section(taken_).v);
  for (std::int64_t p = 1; p <= kMostRepeats; ++p) {
    const double now = distance(taken_, taken_ - p);
    if (now > tolerance_ * size) continue;
    const double before = distance(taken_ - kMemory, taken_ - kMemory - p);
    const double q = now < before ? std::pow(now / before, static_cast<double>(p) / static_cast<double>(kMemory)) : 1.0;
    const bool is_there = now <= kRounding * size || (q < 1.0 && now * q / (1.0 - q) <= tolerance_ * size);
    if (!is_there) continue;
    repeats_ = p;
    return;
  }
}

std::int64_t SteadyWatch::next_alike(double t, std::int64_t settle) const {
  auto first = static_cast<std::int64_t>(std::ceil(t / period_));
  if (static_cast<double>(first) * period_ < t) ++first;
  while (first < settle && (settle - first) % repeats_ != 0) ++first;
  return std::min(first, settle);
}

}  // namespace butee::study

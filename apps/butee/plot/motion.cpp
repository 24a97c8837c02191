#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace butee::app::plot {
namespace {

constexpr std::size_t kPoints = 12000;  ///< total points of a smooth curve
constexpr std::size_t kBetween = 8;     ///< most points between two rows

/// The Hermite cubic with values y0, y1 and slopes d0, d1 at the ends of an interval of length h.
double hermite(double y0, double y1, double d0, double d1, double h, double s) {
  const double r = 1.0 - s;
  return r * r * (1.0 + 2.0 * s) * y0 + s * s * (3.0 - 2.0 * s) * y1 + h * s * r * (r * d0 - s * d1);
}

/// Its derivative.
double hermite_slope(double y0, double y1, double d0, double d1, double h, double s) {
  return 6.0 * s * (1.0 - s) * (y1 - y0) / h + (1.0 - s) * (1.0 - 3.0 * s) * d0 + s * (3.0 * s - 2.0) * d1;
}

}  // namespace

Motion::Point Motion::at(std::size_t i, double s) const {
  const double h = times_[i + 1] - times_[i];
  const double u = hermite(u_[i], u_[i + 1], v_[i], v_[i + 1], h, s);
  if (a_ != nullptr) return {u, hermite(v_[i], v_[i + 1], (*a_)[i], (*a_)[i + 1], h, s)};
  return {u, h > 0.0 ? hermite_slope(u_[i], u_[i + 1], v_[i], v_[i + 1], h, s) : v_[i]};
}

std::vector<Motion::Point> Motion::once_per(double period) const {
  std::vector<Point> points;
  if (times_.size() < 2 || !(period > 0.0)) return points;
  // An instant that misses the last row only by rounding counts as that row.
  const double end = times_.back() + 1e-9 * period;
  std::size_t i = 0;
  for (double k = std::ceil(times_.front() / period - 1e-9); k * period <= end; ++k) {
    const double t = std::min(k * period, times_.back());
    while (i + 2 < times_.size() && times_[i + 1] < t) ++i;
    const double h = times_[i + 1] - times_[i];
    if (h > 0.0) points.push_back(at(i, (t - times_[i]) / h));
  }
  return points;
}

std::vector<Motion::Point> Motion::smooth() const {
  std::vector<Point> points;
  if (times_.empty()) return points;
  const std::size_t between = std::clamp<std::size_t>(kPoints / times_.size(), 1, kBetween);
  for (std::size_t i = 0; i + 1 < times_.size(); ++i)
    for (std::size_t k = 0; k < between; ++k)
      points.push_back(at(i, static_cast<double>(k) / static_cast<double>(between)));
  points.push_back({u_.back(), v_.back()});
  return points;
}

}  // namespace butee::app::plot

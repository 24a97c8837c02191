#include "support/extended_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace butee::test {
namespace {

using Real = long double;
using Series = std::vector<Real>;

constexpr std::size_t kOrder = 26;
/// Number of samples in a piece to detect changes and turning points.
constexpr int kSamples = 8;
constexpr int kBisections = 80;
constexpr Real kAngle = 0.4L;
/// Largest step as a fraction of the distance to the pole of the arctan law.
constexpr Real kOfPole = 0.2L;

Real value(const Series& series, Real s) {
  Real sum = 0.0L;
  for (std::size_t k = series.size(); k-- > 0;) sum = sum * s + series[k];
  return sum;
}

Real slope(const Series& series, Real s) {
  Real sum = 0.0L;
  for (std::size_t k = series.size(); k-- > 1;) sum = sum * s + static_cast<Real>(k) * series[k];
  return sum;
}

/// The position in (a, b) where f changes sign; f(a) has the sign of `at_a`.
template <class Function>
Real bisect(Function f, Real a, Real b, Real at_a) {
  for (int i = 0; i < kBisections; ++i) {
    const Real middle = 0.5L * (a + b);
    (f(middle) * at_a > 0.0L ? a : b) = middle;
  }
  return b;
}

class Integration {
 public:
  Integration(const ExtendedSystem& system, const std::vector<double>& times)
      : system_(system),
        times_(times),
        n_(system.mass.size()),
        x_(system.displacement),
        v_(system.velocity),
        side_(system.stops.size(), 0) {
    motion_.rows.resize(n_);
    motion_.peak.assign(n_, 0.0);
    Real square = 0.0L;
    for (std::size_t i = 0; i < n_; ++i) {
      Real stiffness = 0.0L;
      for (const Real k : system.stiffness[i]) stiffness += std::abs(k);
      for (const auto& stop : system.stops)
        if (stop.a == static_cast<int>(i) || stop.b == static_cast<int>(i)) stiffness += 2.0L * stop.stiffness;
      square = std::max(square, stiffness / system.mass[i]);
      square = std::max(square, std::pow(system.damping[i][i] / system.mass[i], 2));
    }
    for (const auto& load : system.loads) square = std::max(square, load.omega * load.omega);
    longest_ = kAngle / std::sqrt(square);
  }

  ExtendedMotion run() {
    place();
    while (next_ < times_.size()) piece();
    motion_.end_x = x_;
    motion_.end_v = v_;
    return std::move(motion_);
  }

 private:
  Real distance(const ExtendedSystem::Stop& stop, const std::vector<Real>& y) const {
    return y[static_cast<std::size_t>(stop.a)] - (stop.b >= 0 ? y[static_cast<std::size_t>(stop.b)] : 0.0L);
  }

  /// Sets the branch: linear law: the closed side or 0; arctan law: the nearer side.
  void place() {
    for (std::size_t i = 0; i < system_.stops.size(); ++i) {
      const auto& stop = system_.stops[i];
      const Real w = distance(stop, x_), speed = distance(stop, v_);
      const int nearer = stop.sides != 0 ? stop.sides : (w != 0.0L ? w > 0.0L : speed >= 0.0L) ? 1 : -1;
      const Real g = nearer * w - stop.gap;
      side_[i] = stop.slope > 0.0L || g > 0.0L || (g == 0.0L && nearer * speed > 0.0L) ? nearer : 0;
    }
  }

  Real length() const {
    Real h = std::min(longest_, static_cast<Real>(times_.back()) - t_);
    for (const auto& stop : system_.stops) {
      if (stop.slope == 0.0L) continue;
      const Real w = distance(stop, x_), v = std::abs(distance(stop, v_));
      const Real g = (stop.sides != 0 ? stop.sides * w : std::abs(w)) - stop.gap;
      const Real pole = kOfPole * std::hypot(g, 1.0L / stop.slope);
      if (v > 0.0L) h = std::min(h, pole / v);
      h = std::min(h, std::sqrt(pole) / std::sqrt(1e-30L + acceleration_));
    }
    return h;
  }

  void expand(Real h) {
    series_.assign(n_, Series(kOrder + 1, 0.0L));
    std::vector<Series> force(n_, Series(kOrder + 1, 0.0L));
    for (const auto& load : system_.loads) {
      Real term = load.amplitude;
      for (std::size_t k = 0; k <= kOrder; ++k) {
        force[static_cast<std::size_t>(load.dof)][k] +=
            term * std::cos(load.omega * t_ + load.phase + static_cast<Real>(k % 4) * std::numbers::pi_v<Real> / 2.0L);
        term *= load.omega * h / static_cast<Real>(k + 1);
      }
    }
    std::vector<Series> penetration(system_.stops.size()), angle(system_.stops.size());
    for (std::size_t i = 0; i < n_; ++i) {
      series_[i][0] = x_[i];
      series_[i][1] = h * v_[i];
    }
    for (std::size_t k = 0; k + 2 <= kOrder; ++k) {
      for (std::size_t i = 0; i < system_.stops.size(); ++i) {
        const auto& stop = system_.stops[i];
        if (side_[i] == 0) continue;
        const Real w = series_[static_cast<std::size_t>(stop.a)][k] -
                       (stop.b >= 0 ? series_[static_cast<std::size_t>(stop.b)][k] : 0.0L);
        penetration[i].push_back(side_[i] * w - (k == 0 ? stop.gap : 0.0L));
        const Real f = -side_[i] * stop.stiffness * law(stop, penetration[i], angle[i]);
        force[static_cast<std::size_t>(stop.a)][k] += f;
        if (stop.b >= 0) force[static_cast<std::size_t>(stop.b)][k] -= f;
      }
      for (std::size_t i = 0; i < n_; ++i) {
        Real f = force[i][k];
        for (std::size_t j = 0; j < n_; ++j)
          f -= system_.stiffness[i][j] * series_[j][k] +
               system_.damping[i][j] * static_cast<Real>(k + 1) * series_[j][k + 1] / h;
        series_[i][k + 2] = h * h * f / (system_.mass[i] * static_cast<Real>((k + 1) * (k + 2)));
      }
    }
  }

  /// Coefficient k of F/stiffness, given those of g: g itself, or g (1/2 + atan(z)/pi), z = slope g.
  static Real law(const ExtendedSystem::Stop& stop, const Series& g, Series& angle) {
    const std::size_t k = g.size() - 1;
    if (stop.slope == 0.0L) return g[k];
    if (k == 0) {
      angle.assign(1, std::atan(stop.slope * g[0]));
    } else {
      // y' (1 + z^2) = z'
      Real sum = static_cast<Real>(k) * stop.slope * g[k];
      for (std::size_t j = 1; j < k; ++j) sum -= squared(stop.slope, g, j) * static_cast<Real>(k - j) * angle[k - j];
      angle.push_back(sum / (static_cast<Real>(k) * squared(stop.slope, g, 0)));
    }
    Real product = 0.5L * g[k];
    for (std::size_t j = 0; j <= k; ++j) product += g[k - j] * angle[j] / std::numbers::pi_v<Real>;
    return product;
  }

  /// Coefficient j of 1 + z^2.
  static Real squared(Real slope, const Series& g, std::size_t j) {
    Real sum = 0.0L;
    for (std::size_t i = 0; i <= j; ++i) sum += g[i] * g[j - i];
    return slope * slope * sum + (j == 0 ? 1.0L : 0.0L);
  }

  Series path(const ExtendedSystem::Stop& stop, Real factor, Real offset) const {
    Series w = series_[static_cast<std::size_t>(stop.a)];
    if (stop.b >= 0)
      for (std::size_t k = 0; k < w.size(); ++k) w[k] -= series_[static_cast<std::size_t>(stop.b)][k];
    for (Real& c : w) c *= factor;
    w[0] += offset;
    return w;
  }

  /// The first position where phi becomes negative, if it is positive or increasing from zero at the start; 1
  /// if there is none.
  Real first_fall(const Series& phi, Real until) const {
    Real before = 0.0L, slope_before = slope(phi, 0.0L);
    for (int j = 1; j <= kSamples && before < until; ++j) {
      const Real s = std::min(until, static_cast<Real>(j) / kSamples), now = value(phi, s), slope_now = slope(phi, s);
      Real low = s;
      // It may decrease and increase again in between.
      if (now > 0.0L && slope_before < 0.0L && slope_now > 0.0L)
        low = bisect([&](Real r) { return slope(phi, r); }, before, s, slope_before);
      // Right after a change it may increase first.
      Real high = before;
      if (j == 1 && slope_before > 0.0L && slope_now < 0.0L)
        high = bisect([&](Real r) { return slope(phi, r); }, before, s, slope_before);
      if (value(phi, low) < 0.0L && low > high) return bisect([&](Real r) { return value(phi, r); }, high, low, 1.0L);
      before = s;
      slope_before = slope_now;
    }
    return 1.0L;
  }

  void piece() {
    const Real h = length();
    expand(h);
    Real end = 1.0L;
    std::size_t changed = system_.stops.size();
    int becomes = 0;
    for (std::size_t i = 0; i < system_.stops.size(); ++i) {
      const auto& stop = system_.stops[i];
      const auto look = [&](Real factor, Real offset, int to) {
        const Real at = first_fall(path(stop, factor, offset), end);
        if (at < end) end = at, changed = i, becomes = to;
      };
      if (stop.slope > 0.0L) {
        if (stop.sides == 0) look(side_[i], 0.0L, -side_[i]);
      } else if (side_[i] != 0) {
        look(side_[i], -stop.gap, stop.gap == 0.0L && stop.sides == 0 ? -side_[i] : 0);
      } else {
        if (stop.sides >= 0) look(-1.0L, stop.gap, 1);
        if (stop.sides <= 0) look(1.0L, stop.gap, -1);
      }
    }
    record(h, end);
    for (std::size_t i = 0; i < n_; ++i) {
      v_[i] = slope(series_[i], end) / h;
      x_[i] = value(series_[i], end);
    }
    acceleration_ = 0.0L;
    for (std::size_t i = 0; i < n_; ++i) {
      Real a = 0.0L;
      for (std::size_t k = kOrder; k >= 2; --k) a = a * end + static_cast<Real>(k * (k - 1)) * series_[i][k];
      acceleration_ = std::max(acceleration_, std::abs(a) / (h * h));
    }
    t_ += end * h;
    if (changed < side_.size()) side_[changed] = becomes;
  }

  void record(Real h, Real end) {
    for (std::size_t i = 0; i < n_; ++i)
      extreme(series_[i], end,
              [&](Real y) { motion_.peak[i] = std::max(motion_.peak[i], static_cast<double>(std::abs(y))); });
    for (std::size_t i = 0; i < system_.stops.size(); ++i) {
      const auto& stop = system_.stops[i];
      if (side_[i] == 0) continue;
      extreme(path(stop, side_[i], -stop.gap), end, [&](Real g) {
        const Real part = stop.slope == 0.0L ? 1.0L : 0.5L + std::atan(stop.slope * g) / std::numbers::pi_v<Real>;
        motion_.contact_force =
            std::max(motion_.contact_force, static_cast<double>(std::abs(stop.stiffness * part * g)));
      });
    }
    while (next_ < times_.size() && times_[next_] <= t_ + end * h * (1.0L + 1e-18L)) {
      const Real s = (static_cast<Real>(times_[next_]) - t_) / h;
      for (std::size_t i = 0; i < n_; ++i) motion_.rows[i].push_back(value(series_[i], s));
      ++next_;
    }
  }

  template <class Take>
  void extreme(const Series& series, Real end, Take take) const {
    Real before = 0.0L, slope_before = slope(series, 0.0L);
    take(series[0]);
    for (int j = 1; j <= kSamples; ++j) {
      const Real s = end * j / kSamples, slope_now = slope(series, s);
      take(value(series, s));
      if (slope_before * slope_now < 0.0L)
        take(value(series, bisect([&](Real r) { return slope(series, r); }, before, s, slope_before)));
      before = s;
      slope_before = slope_now;
    }
  }

  const ExtendedSystem& system_;
  const std::vector<double>& times_;
  std::size_t n_;
  std::vector<Real> x_, v_;
  std::vector<int> side_;
  std::vector<Series> series_;
  Real t_ = 0.0L, longest_ = 0.0L, acceleration_ = 0.0L;
  std::size_t next_ = 0;
  ExtendedMotion motion_;
};

}  // namespace

ExtendedMotion integrate_extended(const ExtendedSystem& system, const std::vector<double>& times) {
  return Integration(system, times).run();
}

ExtendedGrowth grow_extended(const ExtendedSystem& system, double end_time, Disturbed disturbed) {
  constexpr int kRows = 2000;
  constexpr Real kApart = 1e-14L;
  constexpr double kFar = 1e-4;
  std::vector<double> times;
  for (int i = 0; i <= kRows; ++i) times.push_back(end_time * i / kRows);
  const ExtendedMotion one = integrate_extended(system, times);
  const Real speed = one.peak[0] * std::sqrt((system.stiffness[0][0] + 1e-300L) / system.mass[0]);
  ExtendedSystem moved = system;
  if (disturbed == Disturbed::velocity)
    moved.velocity[0] += kApart * speed;
  else
    moved.displacement[0] += kApart * one.peak[0];
  const ExtendedMotion other = integrate_extended(moved, times);
  // The largest differences in tenths of the run, while they are small.
  double largest = 0.0, first = 0.0, t_first = 0.0, t_last = 0.0, last = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(one.rows[0][i] - other.rows[0][i])));
    if (largest > kFar * one.peak[0]) break;
    if (i <= static_cast<std::size_t>(kRows / 10)) {
      first = largest;
      t_first = times[i];
    }
    last = largest;
    t_last = times[i];
  }
  const double rate = t_last > t_first && first > 0.0 ? std::log(last / first) / (t_last - t_first) : 0.0;
  return {rate, last / (static_cast<double>(kApart) * one.peak[0])};
}

}  // namespace butee::test

#include "integrators/first_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kRounding = std::numeric_limits<double>::epsilon();
/// Rounding error of a jet relative to the bounds of its terms.
constexpr double kNoise = 8.0 * kRounding;
/// A stop that has just changed is on its border within kNearBorder times the rounding error of this contact state, or
/// kNearChange times that of the previous one.
constexpr double kNearBorder = 1e3, kNearChange = 8.0;
/// Bounds are recomputed after the motion has decayed by e to this power.
constexpr double kDecayed = 0.2;
/// The iteration for the root of the bounding cubic ends if its lower bound reaches this fraction
/// of the upper bound.
constexpr double kGood = 0.7;
constexpr int kMostRefinements = 4;
/// After this number of evaluations the piece ends at the time reached.
constexpr int kMostLooks = 20000;

/// The first root s > 0 of g + slope s + curvature s^2/2, g >= 0.
double first_root(double g, double slope, double curvature) {
  const double square = slope * slope - 2.0 * curvature * g;
  if (square < 0.0) return kNever;
  if (slope <= 0.0) {
    const double divisor = std::sqrt(square) - slope;
    return divisor > 0.0 ? 2.0 * g / divisor : kNever;
  }
  return curvature < 0.0 ? (slope + std::sqrt(square)) / -curvature : kNever;
}

}  // namespace

double safe_step(double g, double slope, double curvature, double third) {
  double last = first_root(g, slope, curvature);
  if (!(third > 0.0)) return last;
  double low = 0.0, high = last;
  // For every r the quadratic with the curvature reduced to curvature - third r/3 stays below the
  // cubic up to r.
  if (last == kNever)
    last = std::cbrt(6.0 * g / third) + std::sqrt(6.0 * std::max(slope, 0.0) / third) +
           6.0 * std::max(curvature, 0.0) / third;
  for (int i = 0; i < kMostRefinements && low < kGood * high; ++i) {
    const double root = first_root(g, slope, curvature - third * last / 3.0);
    low = std::max(low, std::min(last, root));
    high = std::min(high, std::max(last, root));
    last = high == kNever ? 2.0 * low : 0.5 * (low + high);
  }
  return low;
}

FirstChange::FirstChange(const SmallSystem& system)
    : system_(system), watches_(static_cast<std::size_t>(system.stop_count())) {}

FirstChange::Result FirstChange::find(const ContactStateFlow& flow, ContactStateFlow::Piece& piece,
                                      std::span<const StopStatus> status, double until, Changed changed,
                                      std::optional<double> chatter) {
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    Watch& watch = watches_[i];
    const LinearStop& stop = system_.stops[i];
    watch = {};
    if (stop.always_closed) {
      watch.next = kNever;
      continue;
    }
    watch.bounds = flow.stop_bounds(piece, static_cast<Index>(i), until);
    if (status[i] == kOpen && watch.bounds[0] < stop.gap)
      watch.next = kNever;
    else {
      watch.sizes = flow.bounds_grow(piece) ? flow.stop_bounds(piece, static_cast<Index>(i), 0.0) : watch.bounds;
      watch.has_changed = static_cast<Index>(i) == changed.stop;
      watch.border = kNearChange * changed.uncertainty;
      look(flow, piece, static_cast<Index>(i), status[i], until, chatter);
      watch.has_changed = false;
    }
  }
  for (int looks = 0; looks < kMostLooks; ++looks) {
    std::size_t first = watches_.size();
    double s = until;
    for (std::size_t i = 0; i < watches_.size(); ++i)
      if (watches_[i].next < s || (watches_[i].next == s && watches_[i].is_change && first == watches_.size())) {
        s = watches_[i].next;
        first = i;
      }
    if (first == watches_.size()) return {until, std::nullopt};
    Watch& watch = watches_[first];
    if (watch.is_change) return {s, Change{static_cast<Index>(first), watch.to, watch.uncertainty}};
    if (s != piece.s) flow.go(piece, s);
    if (flow.largest_decay() * (s - watch.bounded_at) > kDecayed) {
      watch.bounded_at = s;
      const auto bounds = flow.stop_bounds(piece, static_cast<Index>(first), until - s);
      watch.bounds[3] = bounds[3];
      watch.bounds[4] = bounds[4];
    }
    look(flow, piece, static_cast<Index>(first), status[first], until, chatter);
  }
  double s = until;
  for (const Watch& watch : watches_) s = std::min(s, watch.next);
  return {s, std::nullopt};
}

void FirstChange::look(const ContactStateFlow& flow, const ContactStateFlow::Piece& piece, Index i, StopStatus status,
                       double until, std::optional<double> chatter) {
  ++looks_;
  const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
  Watch& watch = watches_[static_cast<std::size_t>(i)];
  const double s = piece.s;
  const Jet w = flow.stop(piece, i);
  watch.next = kNever;
  watch.is_change = false;
  const auto& bounds = watch.bounds;
  std::array<double, 4> noise;
  for (std::size_t k = 0; k < 4; ++k) noise[k] = kNoise * (watch.sizes[k] + std::abs(w[k]));
  // Rounding of the gap, of both ends and of the instant. Rounding of x affects the derivatives of
  // every mode.
  noise[0] += kNoise * (std::abs(stop.gap) + piece.displacement) + kRounding * std::abs(w[1]) * (std::abs(piece.t) + s);
  noise[1] += kNoise * piece.speed;
  for (std::size_t k = 1; k < 4; ++k) noise[k] += flow.fastest() * noise[k - 1];
  const auto displacement = [&](double sign, double offset, StopStatus to) {
    return Function{
        {offset + sign * w[0], sign * w[1], sign * w[2], sign * w[3]}, noise, bounds[3], bounds[4], to, 1.0};
  };
  if (status == kOpen) {
    // The nearer side first; its safe step mostly shows that nothing happens at the other side.
    const double nearer = w[0] < 0.0 ? -1.0 : 1.0;
    for (const double side : {nearer, -nearer})
      if (side > 0.0 ? stop.positive : stop.negative)
        consider(displacement(-side, stop.gap, on_side(kClosed, side)), s, until, piece.t, chatter, watch);
    return;
  }
  const double side = status > 0 ? 1.0 : -1.0;
  const bool pushes_only = stop.damping > 0.0 && !stop.pulls;
  if (!pushes_only || !is_closed(status))
    consider(displacement(side, -stop.gap, kOpen), s, until, piece.t, chatter, watch);
  if (!pushes_only) return;
  const double k = stop.stiffness, c = stop.damping, sign = is_closed(status) ? 1.0 : -1.0;
  Function force;
  force.g = {sign * (k * (side * w[0] - stop.gap) + c * side * w[1]), sign * side * (k * w[1] + c * w[2]),
             sign * side * (k * w[2] + c * w[3]), 0.0};
  for (std::size_t order = 0; order < 3; ++order) force.noise[order] = k * noise[order] + c * noise[order + 1];
  force.noise[3] = kNever;
  force.third = force.fourth = k * bounds[3] + c * bounds[4];
  force.per_displacement = k;
  force.to = on_side(is_closed(status) ? kReleased : kClosed, side);
  consider(force, s, until, piece.t, chatter, watch);
}

void FirstChange::consider(const Function& function, double s, double until, double t, std::optional<double> chatter,
                           Watch& watch) const {
  const Jet& g = function.g;
  const std::array<double, 4>& noise = function.noise;
  const double third = function.third, fourth = function.fourth, per_displacement = function.per_displacement;
  const StopStatus to = function.to;
  // A change was located to the rounding error of the previous contact state, which may be far larger: a light body on
  // a soft spring under a load has a static displacement of many gaps where it is free.
  const bool is_on_border =
      watch.has_changed && std::abs(g[0]) <= std::max(kNearBorder * noise[0], watch.border * per_displacement);
  const auto suggest = [&](double next, bool is_change) {
    if (next < watch.next) {
      watch.next = next;
      watch.is_change = is_change;
      watch.to = to;
      watch.uncertainty = noise[0] / per_displacement;
    }
  };
  double step = 0.0;
  if (g[0] > noise[0] && !is_on_border) {
    const double known = watch.next - s;
    if (known < kNever &&
        g[0] > known * (std::abs(g[1]) + known * (0.5 * std::abs(g[2]) + known * third / 6.0)) + noise[0])
      return;
    step = safe_step(g[0], g[1], g[2], third);
    const bool is_root =
        g[1] + g[2] * step < 0.0 && (third * step * step * step <= noise[0] || step <= kRounding * (std::abs(t) + s));
    return suggest(s + step, is_root && s + step <= until);
  }
  if (chatter && g[0] >= -std::max(kNearBorder * noise[0], kNearChange * *chatter * per_displacement)) {
    step = third > 0.0 ? std::cbrt(6.0 * noise[0] / third) : until;
    return suggest(s + std::max(step, 4.0 * kRounding * (std::abs(t) + s)), false);
  }
  // On the border the first derivative that exceeds rounding decides. If it is the second or third and positive, the
  // function falls by its rounding error at most within `hidden`: a derivative that barely exceeds its own rounding
  // error would give far shorter steps.
  const double here = std::max(g[0], 0.0), cubic = third > 0.0 ? std::cbrt(6.0 * noise[0] / third) : kNever;
  double hidden = cubic;
  if (noise[1] > 0.0) hidden = std::min(hidden, noise[0] / noise[1]);
  if (noise[2] > 0.0) hidden = std::min(hidden, std::sqrt(2.0 * noise[0] / noise[2]));
  if ((g[0] < -4.0 * noise[0] && !is_on_border) || g[1] < -noise[1]) return suggest(s, true);
  if (g[1] > noise[1]) {
    step = safe_step(here, g[1], g[2], third);
  } else if (g[2] < -noise[2]) {
    return suggest(s, true);
  } else if (g[2] > noise[2]) {
    step = std::max(third > 0.0 ? 3.0 * g[2] / third : kNever, hidden);
  } else if (g[3] < -noise[3]) {
    return suggest(s, true);
  } else if (g[3] > noise[3]) {
    step = std::max(fourth > 0.0 ? 4.0 * g[3] / fourth : kNever, hidden);
  } else {
    step = cubic;
  }
  suggest(s + std::max(step, 4.0 * kRounding * (std::abs(t) + s)), false);
}

}  // namespace butee::integrators

#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace butee::time {

/// A function of time at an instant.
struct Look {
  double t = 0.0, value = 0.0;
};

/// The lowest point of the parabola through three looks, the middle one of which is lowest. None if
/// rounding hides the curvature.
inline std::optional<Look> lowest_of(const std::array<Look, 3>& looks) {
  const auto& [first, second, third] = looks;
  const double rise = (second.value - first.value) / (second.t - first.t),
               next = (third.value - second.value) / (third.t - second.t), bend = (next - rise) / (third.t - first.t);
  if (!(bend > 0.0)) return std::nullopt;
  const double slope = rise + bend * (second.t - first.t), way = -0.5 * slope / bend;
  const Look lowest{second.t + way, second.value + 0.5 * slope * way};
  if (!(lowest.t > first.t && lowest.t < third.t) || lowest.t == second.t) return std::nullopt;
  return lowest;
}

/// An instant within a dip at which the function is negative, and the last look before it at which
/// it is not. None if the dip stays above zero. `function` gives the value at an instant; `looks`
/// as for lowest_of.
template <typename Function>
std::optional<std::pair<Look, Look>> below_zero(std::array<Look, 3> looks, const Function& function) {
  constexpr int kMostParabolas = 8;
  constexpr double kDipError = 4.0;  // the search stops if the lowest value exceeds this multiple of the parabola's
                                     // error
  for (int i = 0; i < kMostParabolas; ++i) {
    const std::optional<Look> expected = lowest_of(looks);
    if (!expected) return std::nullopt;
    const Look found{expected->t, function(expected->t)};
    auto& [first, second, third] = looks;
    if (found.value < 0.0) return std::pair{found, found.t > second.t ? second : first};
    // The parabola's error elsewhere in the dip is taken to be its error here.
    if (found.value > kDipError * std::abs(found.value - expected->value)) return std::nullopt;
    if (found.t > second.t) {
      found.value < second.value ? first = second, second = found : third = found;
    } else {
      found.value < second.value ? third = second, second = found : first = found;
    }
  }
  return std::nullopt;
}

}  // namespace butee::time

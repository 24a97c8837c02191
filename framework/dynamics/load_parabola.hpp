#pragma once

#include <algorithm>
#include <cmath>

#include "butee/model/time_function.hpp"

namespace butee::dynamics {

/// A load over a step from t to t_end without a discontinuity within it: the parabola through its values at the
/// beginning, in the middle and at the end. Where the load jumps at t_end, the last value is its limit from the left.
struct LoadParabola {
  double begin, middle, end;

  LoadParabola(const model::TimeFunction& load, double t, double t_end)
      : begin(load.value(t)), middle(0.0), end(load.value(t_end)) {
    const double h = t_end - t;
    if (h < kShortest * t_end) {
      middle = 0.5 * (begin + end);
      return;
    }
    middle = load.value(t + 0.5 * h);
    const double late = load.value(t + 0.75 * h);
    if (std::abs(late - at(0.75)) > kContinuous * (std::abs(begin) + std::abs(middle) + std::abs(end)))
      end = begin / 3.0 - 2.0 * middle + 8.0 / 3.0 * late;
  }

  double bend() const { return begin - 2.0 * middle + end; }
  /// The value at t + s h.
  double at(double s) const { return begin + s * (4.0 * middle - 3.0 * begin - end + 2.0 * s * bend()); }
  /// A bound of the magnitude over the step.
  double largest() const {
    return std::max({std::abs(begin), std::abs(middle), std::abs(end)}) + 0.5 * std::abs(bend());
  }

 private:
  /// In a step shorter than this fraction of the time, the load in the middle is taken as the mean of those at the
  /// ends, since rounding would move the middle by more than 1e-9 of h.
  static constexpr double kShortest = 2e-7;
  /// Ten times the change by such rounding.
  static constexpr double kContinuous = 1e-8;
};

}  // namespace butee::dynamics

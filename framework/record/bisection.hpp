#pragma once

namespace butee::record {

/// Halves an interval in time until no double lies within it, or 60 times, and returns its end: the first instant, s,
/// that `is_before` does not take for one before the change.
template <class IsBefore>
double bisect(double begin, double end, const IsBefore& is_before) {
  constexpr int kMostHalvings = 60;
  for (int i = 0; i < kMostHalvings; ++i) {
    const double middle = 0.5 * (begin + end);
    if (middle <= begin || middle >= end) break;
    (is_before(middle) ? begin : end) = middle;
  }
  return end;
}

}  // namespace butee::record

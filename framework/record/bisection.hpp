#pragma once

#include <algorithm>
#include <cmath>

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

/// The root between two instants a and b of a function that has values of opposite sign there, by regula falsi; the
/// value at an end that stays is halved (Illinois). To `part` of the interval or of the values, or after 60
/// evaluations.
template <class Function>
double root_between(double a, double at_a, double b, double at_b, double part, const Function& function) {
  const double shortest = part * (b - a), least = part * std::max(std::abs(at_a), std::abs(at_b));
  constexpr int kMostEvaluations = 60;
  double root = a;
  int stays = 0;
  for (int i = 0; i < kMostEvaluations && b - a > shortest; ++i) {
    root = a + (b - a) * at_a / (at_a - at_b);
    if (!(root > a && root < b)) return root;  // no instant lies between them
    const double value = function(root);
    if (std::abs(value) <= least) return root;
    const bool is_before = (value > 0.0) == (at_a > 0.0);
    (is_before ? a : b) = root;
    (is_before ? at_a : at_b) = value;
    if (stays == (is_before ? 1 : -1)) (is_before ? at_b : at_a) *= 0.5;
    stays = is_before ? 1 : -1;
  }
  return root;
}

}  // namespace butee::record

#pragma once

#include <cmath>

namespace butee::record {

/// An instant and a value there.
struct Sampled {
  double t = 0.0, value = 0.0;
};

/// The largest value of a function f(t) near b, between a and c, with a.t < b.t < c.t and b.value
/// not less than the others. Uses the vertices of parabolas through three points, and golden
/// sections if these do not converge. For a smooth f the relative error is about 1e-12.
template <class Function>
Sampled local_maximum(Sampled a, Sampled b, Sampled c, Function f) {
  constexpr int kMost = 40;
  constexpr double kGolden = 0.3819660112501051, kFine = 1e-6;
  const double width = c.t - a.t;
  for (int i = 0; i < kMost && c.t - a.t > kFine * width; ++i) {
    const double left = (b.t - a.t) * (b.value - c.value), right = (b.t - c.t) * (b.value - a.value);
    double t = b.t - 0.5 * ((b.t - a.t) * left - (b.t - c.t) * right) / (left - right);
    const double least = 0.5 * kFine * width;
    // Parabolas may converge from one side only: every third step is a golden section of the longer
    // part.
    const bool is_in_left = b.t - a.t > c.t - b.t;
    if (!(t > a.t && t < c.t) || i % 3 == 2) t = b.t + kGolden * (is_in_left ? a.t - b.t : c.t - b.t);
    if (std::abs(t - b.t) < least) t = b.t + (is_in_left ? -least : least);
    const Sampled now{t, f(t)};
    if (now.value > b.value) {
      (t < b.t ? c : a) = b;
      b = now;
    } else {
      (t < b.t ? a : c) = now;
    }
  }
  return b;
}

}  // namespace butee::record

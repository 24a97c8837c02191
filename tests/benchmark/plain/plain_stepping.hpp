#pragma once

#include <algorithm>
#include <cmath>

#include "plain.hpp"

namespace plain {

/// An adaptive method stops below this fraction of its initial step.
inline constexpr double kStepFloor = 1e-10;

/// Records the step from t to t + h that ended with u and v.
inline void record(Result& result, const Options& options, double t, double h, double u, double v) {
  ++result.steps;
  while (result.u_samples.size() < options.samples.size()) {
    const double s = (options.samples[result.u_samples.size()] - t) / h, r = 1.0 - s;
    if (s > 1.0 + 1e-9) break;
    result.u_samples.push_back(r * r * ((1.0 + 2.0 * s) * result.u_end + s * h * result.v_end) +
                               s * s * ((3.0 - 2.0 * s) * u - r * h * v));
  }
  result.u_end = u;
  result.v_end = v;
  result.peak_u = std::max(result.peak_u, std::abs(u));
  result.peak_v = std::max(result.peak_v, std::abs(v));
}

/// Calls step(t, h) at t = n h; the last step is shorter if the end is not a multiple of h.
template <typename Step>
void march_fixed(const Options& options, const Step& step) {
  const double h = options.time_step;
  const long whole = static_cast<long>(std::floor(options.end_time / h + 1e-9));
  for (long n = 0; n < whole; ++n) step(static_cast<double>(n) * h, h);
  const double t = static_cast<double>(whole) * h;
  if (options.end_time - t > 1e-9 * h) step(t, options.end_time - t);
}

/// The outcome of an attempted step: acceptance and the next step size.
struct Verdict {
  bool accepted;
  double next;
};

/// Calls attempt(t, h) until the end; the last step is shortened to reach it exactly.
template <typename Attempt>
void march_adaptive(const Options& options, Result& result, const Attempt& attempt) {
  double t = 0.0, h = options.time_step;
  while (t < options.end_time) {
    const double left = options.end_time - t;
    const bool last = h >= left;
    if (last) h = left;
    const Verdict verdict = attempt(t, h);
    if (verdict.accepted) {
      t = last ? options.end_time : t + h;
    } else {
      ++result.rejected;
      if (!(verdict.next > kStepFloor * options.time_step)) {
        result.completed = false;
        return;
      }
    }
    h = verdict.next;
  }
}

void run_runge_kutta(const Problem& problem, Method method, const Options& options, Result& result);
void run_newmark(const Problem& problem, Method method, const Options& options, Result& result);

}  // namespace plain

#pragma once

#include <array>
#include <utility>

#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

/// The series for the responses of modes with w = lambda c h near 0. `Part` is a fixed-size array of modes or of
/// positions c.
struct ResponseSeries {
  static constexpr int kPowers = static_cast<int>(StepNodes::kCount);

  /// Up to this |w| moments are summed as series; the last of kMostTerms terms is then below rounding.
  static constexpr double kSmall = 7.0;

  /// Calls put(r, re, im) with moment_r for r = 6, ..., 0, from
  ///
  ///     moment_6 = h c^7 sum_k w^k 6!/(7+k)!,   moment_(r-1) = (lambda h moment_r + h c^r)/r
  ///
  /// for lambda h = dr + i di, w = wr + i wi with |w| up to `largest` <= kSmall, and powers[r] = h c^r.
  template <class Part, class Rate, class Put>
  static void moments(const Rate& dr, const Rate& di, const Part& wr, const Part& wi,
                      const std::array<Part, kPowers + 1>& powers, double largest, const Put& put) {
    constexpr int kTop = kPowers - 1, kMostTerms = 34;
    constexpr double kRounding = 1e-18;
    Part tr = powers[kPowers] / kPowers, ti = Part::Zero(), sr = tr, si = ti;
    double bound = 1.0;
    for (int n = 1; n < kMostTerms && bound > kRounding; ++n) {
      const double factor = 1.0 / (kTop + n + 1);
      bound *= largest * factor;
      next_term(factor, wr, wi, tr, ti);
      sr += tr;
      si += ti;
    }
    for (int r = kTop; r >= 0; --r) {
      put(r, sr, si);
      if (r == 0) break;
      const double part = 1.0 / r;
      const Part re = part * (dr * sr - di * si + powers[static_cast<std::size_t>(r)]);
      si = part * (dr * si + di * sr);
      sr = re;
    }
  }

  /// Up to this |w|^2, (e^w - 1)/w is summed as a series. Above it, one digit cancels at most.
  static constexpr double kNearResonance = 0.01;

  /// The real and the imaginary part of (e^w - 1)/w.
  template <class Part>
  static std::pair<Part, Part> phi(const Part& wr, const Part& wi) {
    constexpr int kTerms = 12;
    Part tr = Part::Ones(), ti = Part::Zero(), sr = tr, si = ti;
    for (int n = 2; n < kTerms; ++n) {
      next_term(1.0 / n, wr, wi, tr, ti);
      sr += tr;
      si += ti;
    }
    return {sr, si};
  }

 private:
  template <class Part>
  static void next_term(double factor, const Part& wr, const Part& wi, Part& tr, Part& ti) {
    const Part re = factor * (tr * wr - ti * wi);
    ti = factor * (tr * wi + ti * wr);
    tr = re;
  }
};

}  // namespace butee::integrators

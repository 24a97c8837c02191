#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include "integrators/exponential/response_series.hpp"

namespace butee::integrators {

/// The phase angle Omega L of a harmonic load over a length L, its cosine and its sine.
template <class Part>
struct HarmonicAngle {
  double frequency;  ///< Omega, rad/s
  Part length, angle, cosine, sine;
};

/// The responses of damped modes z' = lambda z + f to f = cos(Omega tau) and f = sin(Omega tau) from z(0) = 0:
///
///     P = int_0^L e^(lambda (L - tau)) cos(Omega tau) dtau,    Q = int_0^L e^(lambda (L - tau)) sin(Omega tau) dtau
///
/// Real and imaginary parts are each accurate to their own rounding if lambda is imaginary, since the imaginary part of
/// a slow or rigid motion is small beside the real one. `Part` is a fixed-size array of modes or of lengths L.
template <class Part>
struct HarmonicResponse {
  Part cosine_re, cosine_im, sine_re, sine_im;

  /// `lambda` = decay + i turn, and its propagator e^(lambda L) = pr + i pi.
  HarmonicResponse(const HarmonicAngle<Part>& load, const Part& decay, const Part& turn, const Part& pr,
                   const Part& pi) {
    const double frequency = load.frequency;
    const Part er = pr - load.cosine;
    // P = (lambda E + Omega sin(Omega L))/D, Q = (Omega E - lambda sin(Omega L))/D, with E = e^(lambda L) - cos(Omega
    // L) and D = lambda^2 + Omega^2
    const Part dr = (frequency - turn) * (frequency + turn) + decay.square(), di = 2.0 * decay * turn,
               inverse = (dr.square() + di.square()).max(std::numeric_limits<double>::min()).inverse();
    const auto divide = [&](const Part& nr, const Part& ni, Part& re, Part& im) {
      re = inverse * (nr * dr + ni * di);
      im = inverse * (ni * dr - nr * di);
    };
    divide(decay * er - turn * pi + frequency * load.sine, decay * pi + turn * er, cosine_re, cosine_im);
    divide(frequency * er - decay * load.sine, frequency * pi - turn * load.sine, sine_re, sine_im);
    const Part wr = decay * load.length, wi = turn * load.length,
               size = (wr.square() + wi.square()).max(load.angle.square());
    const auto is_small = (size <= kSmall * kSmall).eval();
    if (is_small.any()) use_series(is_small, std::sqrt(is_small.select(size, 0.0).maxCoeff()), load, wr, wi);
    const auto is_near =
        (wr.square() + (wi - load.angle.abs()).square() <= ResponseSeries::kNearResonance && !is_small).eval();
    if (is_near.any()) use_resonance(is_near, load, wr, wi, pr, pi);
  }

  /// The response to cosine cos(Omega tau) + sine sin(Omega tau), complex coefficients in `re` + i `im`.
  template <class In>
  std::pair<Part, Part> of(const In& cosine_r, const In& cosine_i, const In& sine_r, const In& sine_i) const {
    return {cosine_re * cosine_r - cosine_im * cosine_i + sine_re * sine_r - sine_im * sine_i,
            cosine_re * cosine_i + cosine_im * cosine_r + sine_re * sine_i + sine_im * sine_r};
  }

 private:
  /// Up to this |lambda L| and |Omega L| series are summed, until the bound of their terms is below kRounding. Above it
  /// the closed form loses two digits at most.
  static constexpr double kSmall = 0.3, kRounding = 1e-17;

  using Mask = Eigen::Array<bool, Part::RowsAtCompileTime, 1>;

  /// P = L sum_n S_n/(n + 1)!, Q = L Omega L sum_n S_n/(n + 2)!, S_n = sum_j (-(Omega L)^2)^j (lambda L)^(n - 2 j).
  /// `largest` is the largest |lambda L| and |Omega L|.
  void use_series(const Mask& is_small, double largest, const HarmonicAngle<Part>& load, const Part& wr,
                  const Part& wi) {
    const Part square = -load.angle.square();
    Part sr = Part::Ones(), si = Part::Zero(), even = sr, pr = sr, pi = si, qr = 0.5 * sr, qi = si;
    double factor = 1.0, bound = 1.0;  // 1/(n + 1)!; largest^n/n!
    for (int n = 1; bound > kRounding; ++n) {
      const Part re = sr * wr - si * wi;
      si = sr * wi + si * wr;
      sr = re;
      if (n % 2 == 0) {
        even *= square;
        sr += even;
      }
      factor /= n + 1;
      bound *= largest / n;
      pr += factor * sr;
      pi += factor * si;
      const double next = factor / (n + 2);
      qr += next * sr;
      qi += next * si;
    }
    cosine_re = is_small.select(load.length * pr, cosine_re);
    cosine_im = is_small.select(load.length * pi, cosine_im);
    sine_re = is_small.select(load.length * load.angle * qr, sine_re);
    sine_im = is_small.select(load.length * load.angle * qi, sine_im);
  }

  /// P = (R + R')/2 and Q = (R - R')/(2 i) from the responses R and R' to e^(i Omega tau) and e^(-i Omega tau), of
  /// which the resonant one is e^(lambda L) L (e^w - 1)/w with a small w.
  void use_resonance(const Mask& is_near, const HarmonicAngle<Part>& load, const Part& wr, const Part& wi,
                     const Part& pr, const Part& pi) {
    const Part sense = (load.angle < 0.0).select(-Part::Ones(), Part::Ones()), angle = load.angle.abs();
    const auto [fr, fi] = ResponseSeries::phi(Part(-wr), Part(angle - wi));
    const Part near_re = load.length * (pr * fr - pi * fi), near_im = load.length * (pr * fi + pi * fr);
    // (e^(-i |Omega| L) - e^(lambda L)) L/(-i |Omega| L - lambda L)
    const Part dr = -wr, di = -angle - wi, er = load.cosine - pr, ei = -sense * load.sine - pi,
               inverse = load.length / (dr.square() + di.square()).max(std::numeric_limits<double>::min()),
               far_re = inverse * (er * dr + ei * di), far_im = inverse * (ei * dr - er * di);
    cosine_re = is_near.select(0.5 * (near_re + far_re), cosine_re);
    cosine_im = is_near.select(0.5 * (near_im + far_im), cosine_im);
    sine_re = is_near.select(0.5 * sense * (near_im - far_im), sine_re);
    sine_im = is_near.select(-0.5 * sense * (near_re - far_re), sine_im);
  }
};

}  // namespace butee::integrators

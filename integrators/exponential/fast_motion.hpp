#pragma once

#include "integrators/exponential/modal_response.hpp"

namespace butee::integrators {

/// The motion of fast damped modes within one step, without truncation error:
///
///     z(t + s h) = e^(lambda s h) c + sum_r p_r s^r + harmonics,   p_r = ((r + 1) p_(r+1)/h - g_r)/lambda
///
/// The constants are found once for a step, so that an instant costs an exponential function and a
/// polynomial for each mode. Checked in tests/verification/damped_modes_test.cpp.
class FastMotion {
 public:
  /// The smallest |lambda| h: the terms of p_0 are up to 6!/kLeast^6 times g/lambda, so that at
  /// most three digits cancel.
  static constexpr double kLeast = 1.0;

  /// Both must outlive it.
  FastMotion(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads)
      : modes_(modes), loads_(loads) {}

  /// Sets the step of length h from t, for the modes from `first` on; arguments as for
  /// PlaceResponse::move(). False if a load nearly resonates with one of the modes: digits would then cancel.
  bool begin(double t, double h, const double* z, const double* g, Index first);
  /// |c| of these modes, at the start of the step.
  Eigen::ArrayXd amplitudes() const { return (free_.re.col(0).square() + free_.im.col(0).square()).sqrt(); }
  /// Fills the entries of these modes in `z` (2p) with the motion at a position of the step.
  void move(double place, Eigen::Ref<Eigen::VectorXd> z);

 private:
  /// The smallest |i Omega - lambda| h.
  static constexpr double kResonant = 0.1;

  /// Real and imaginary parts: one column for each power or load.
  struct Parts {
    Eigen::ArrayXXd re, im;
    void resize(Index rows, Index columns) {
      re.resize(rows, columns);
      im.resize(rows, columns);
    }
  };

  const dynamics::DampedModes& modes_;
  const std::vector<HarmonicLoad>& loads_;
  double t_ = 0.0, h_ = 0.0;  ///< s
  Index first_ = 0;
  Parts free_, polynomial_;  ///< c; p_r
  Parts cosine_, sine_;      ///< the responses to harmonic loads are cosine cos(Omega t) + sine sin(Omega t)
  Parts turned_, sum_;       ///< at the position
};

}  // namespace butee::integrators

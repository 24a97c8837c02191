#pragma once

#include <vector>

#include <Eigen/Core>
#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::dynamics {

/// Modal forces cosine cos(Omega t) + sine sin(Omega t).
struct ModalHarmonic {
  double angular_frequency = 0.0;  ///< Omega, rad/s
  Eigen::ArrayXd cosine, sine;     ///< one entry per mode
};

/// The exact motion of uncoupled modes over one step of length h:
///
///     q'' + 2 delta q' + omega^2 q = f_0 P_0 + f_1 P_1 + f_2 P_2 + harmonics
///     q(h) = qq q + qv v + sum_k force_q(k) f_k + Re(e^(i Omega t) harmonic_q),   v(h) likewise
///
/// with the shifted Legendre polynomials P_k of the position in the step. Every quantity is a
/// column with one entry per mode; modes may be rigid, vibrating, or overdamped. The propagator is
/// built from a Taylor series over a length that is short for every mode, followed by doublings;
/// neither has special cases. The free motion of the result can then be replaced by its closed
/// form. Checked against closed forms in tests/unit/modal_propagator_test.cpp.
class BUTEE_EXPORT ModalPropagator {
 public:
  /// omega and delta in 1/s; `h` in s.
  ModalPropagator(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
                  double h);

  /// The largest h that needs no doubling, s.
  static double longest_series(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta,
                               const std::vector<ModalHarmonic>& harmonics);

  /// The propagator over 2 h.
  ModalPropagator doubled() const;
  /// Replaces the free motion by its closed form, whose error does not grow with the number of
  /// doublings.
  void refine(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta);

  double h() const { return h_; }

  auto qq() const { return columns_.col(0); }
  auto qv() const { return columns_.col(1); }
  auto vq() const { return columns_.col(2); }
  auto vv() const { return columns_.col(3); }
  /// The response of q and v to a force P_k, k = 0, 1, 2.
  auto force_q(int k) const { return columns_.col(kForce + 2 * k); }
  auto force_v(int k) const { return columns_.col(kForce + 2 * k + 1); }
  /// All six columns: q and v of P_0, then of P_1 and P_2.
  auto forces() const { return columns_.middleCols(kForce, 6).matrix(); }

  /// The response to the harmonics in a step that begins at t: q += harmonic_q(j, 0) cos(Omega_j
  /// t) - harmonic_q(j, 1) sin(Omega_j t).
  const std::vector<double>& angular_frequencies() const { return angular_frequencies_; }
  auto harmonic_q(std::size_t j, int part) const { return columns_.col(harmonic_column(j) + 2 * part); }
  auto harmonic_v(std::size_t j, int part) const { return columns_.col(harmonic_column(j) + 2 * part + 1); }

 private:
  static constexpr Index kForce = 4, kHarmonic = 10;
  static Index harmonic_column(std::size_t j) { return kHarmonic + 4 * static_cast<Index>(j); }

  ModalPropagator() = default;
  void start_by_series(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta,
                       const std::vector<ModalHarmonic>& harmonics);

  double h_ = 0.0;
  std::vector<double> angular_frequencies_;
  Eigen::ArrayXXd columns_;
};

}  // namespace butee::dynamics

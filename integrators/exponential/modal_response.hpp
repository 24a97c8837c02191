#pragma once

#include <vector>

#include <Eigen/Core>

#include "butee/dynamics/damped_modes.hpp"
#include "integrators/exponential/response_series.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

/// A load cosine cos(Omega t) + sine sin(Omega t) on all modes, 2p numbers each, or the response to it.
struct HarmonicLoad {
  double angular_frequency;  ///< rad/s
  Eigen::VectorXd cosine, sine;
};

/// The motion of damped modes at one position c h of a step of length h, without truncation error:
///
///     z(t + c h) = e^(lambda c h) z(t) + sum_r moment_r g_r + harmonics,   g_r the coefficient of s^r in the force
///
/// For small |lambda c h| the moments follow from a series and a downward recurrence, for large
/// ones from the upward recurrence; each recurrence is stable in its range. Checked in
/// tests/verification/damped_modes_test.cpp.
class PlaceResponse {
 public:
  /// Handles all modes.
  PlaceResponse(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads, double place, double h)
      : PlaceResponse(modes, loads, place, h, 0, modes.count()) {}
  /// Handles the modes from `first` to `last` - 1; the member functions leave the others unchanged.
  PlaceResponse(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads, double place, double h,
                Index first, Index last);

  /// out := z at the position. `z` holds 2p numbers; `g` holds the coefficients of 1, s, ..., s^6
  /// one after the other, 2p numbers each, or is null if only harmonic loads act.
  void move(double t, const double* z, const double* g, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Adds the response to the force `g` to `out`.
  void add_force(const double* g, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  using ConstArrayRef = Eigen::Ref<const Eigen::ArrayXd>;
  void find_moments(ConstArrayRef decay, ConstArrayRef turn, ConstArrayRef speed, double place, double h);
  void add_harmonics(ConstArrayRef decay, ConstArrayRef turn, const HarmonicLoad& load, double length);

  Index first_, count_;
  Eigen::ArrayXXd propagator_;           ///< p x 2
  Eigen::ArrayXXd moments_;              ///< p x 14: real and imaginary parts of each moment
  std::vector<HarmonicLoad> harmonics_;  ///< the responses
};

}  // namespace butee::integrators

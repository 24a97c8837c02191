#pragma once

#include <algorithm>

#include "butee/dynamics/modal_system.hpp"

namespace butee::integrators {

/// The mean over a step of the displacement of a stop that its path misses, per unit amplitude of a mode that turns by
/// `theta`, rad, in the step: a bound of the root of the mean square over its phases (plugins/exponential/constants.py).
inline double missed_mean(double theta) {
  constexpr double kMissedPower = 1.2e-6, kMissedGrowth = 1.0 / 60.0;
  const double cube = theta * theta * theta, power = kMissedPower * cube * cube;
  return power / (1.0 + power) * (1.0 + kMissedGrowth * theta);
}
/// The coefficient of P_3 of that displacement, which the projection of the force leaves out.
inline double missed_cubic(double theta) {
  constexpr double kMissedCubic = 1.0 / 169.0, kMostCubic = 1.2;
  return std::min(kMissedCubic * theta * theta * theta, kMostCubic);
}
/// A bound of the velocity at the end of a step of a mode that turns by `theta`, rad, under a constant force of unit
/// impulse.
inline double received_mean(double theta) {
  return theta < 2.0 ? 1.0 : 2.0 / theta;
}
/// The same for a force of the form P_3.
inline double received_cubic(double theta) {
  constexpr double kReceivedCubic = 1.0 / 840.0, kMostReceived = 0.25;
  return std::min({kReceivedCubic * theta * theta * theta, kMostReceived, 2.0 / theta});
}

/// The errors of the velocities of all components by the part of the forces of closed stops that their projections miss
/// (indicator 10 of plugins/exponential/THEORY.md, section 8.1): the modes that move a stop excite all modes through
/// its force. Checked in tests/models/exponential_closed_stops_test.cpp.
class MissedForces {
 public:
  /// `modal` must outlive it.
  explicit MissedForces(const dynamics::ModalSystem& modal);

  /// Sets the amplitudes of the modes' velocities, the stiffness of each stop that stays closed (0: others), N/m, and
  /// the largest velocities of the DOFs so far, which are raised to a tenth of those that the modes will cause.
  void begin(const Eigen::ArrayXd& amplitudes, const Vector& stiffness, const Vector& speeds);
  /// The raised largest velocities, m/s or rad/s.
  const Vector& speeds() const { return speeds_; }
  /// The error in a step of length h, relative to the largest velocity of the component that it affects most. Errors
  /// of up to `enough` may be returned larger, up to `enough`.
  double error(double h, double enough);

 private:
  double of_stop(Index stop, double enough);

  const dynamics::ModalSystem& modal_;
  Eigen::ArrayXd row_squares_;  ///< sum of squares of the shapes of each DOF, 1/kg
  Eigen::ArrayXd swing_;        ///< displacements of the modes, kg^(1/2) m
  Vector stiffness_, speeds_;
  Eigen::ArrayXd weights_;                            ///< 1/speeds_^2
  double largest_row_ = 0.0;                          ///< the largest row_squares_ times weights_
  Eigen::ArrayXd mean_, cubic_, to_mean_, to_cubic_;  ///< of each mode for steps of h_
  Eigen::ArrayXd work_;
  double h_ = 0.0, error_ = 0.0, enough_ = 0.0;  ///< error_ is error(h_, enough_)
};

}  // namespace butee::integrators

#pragma once

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

/// How fast the fastest DOFs of a structure can move, 1/s: that of single DOFs, by the diagonals of the matrices. The
/// fastest mode of coupled DOFs is faster.
struct FastestRates {
  double open = 0.0;      ///< frequency, rad/s, with all stops open; 0 without any stiffness
  double closed = 0.0;    ///< that with all stops closed, or rate in the steep part of a smooth friction law
  double damping = 0.0;   ///< rate at which damping decelerates a DOF
  double friction = 0.0;  ///< that in the steep part of the friction law of a support
  /// closed or damping, the larger one; 0 without any stiffness.
  double any() const { return closed > 0.0 && damping > closed ? damping : closed; }
};

FastestRates fastest_rates(dynamics::Dynamics& dynamics);

/// An upper bound of the rate at which damping decelerates coupled DOFs, 1/s: the largest row sum of m^(-1/2) C
/// m^(-1/2) with the diagonal m of M. Too low by at most the ratio of m to M; without modal damping.
double bound_of_damping(const model::System& system);

}  // namespace butee::integrators

#pragma once

#include <string>

#include "butee/dynamics/structure.hpp"

namespace butee::dynamics {

/// The lowest natural modes of an undamped structure: K phi_i = omega_i^2 M phi_i, Phi^T M Phi = 1.
struct NaturalModes {
  std::string problem;     ///< why there are none; empty on success
  Vector frequencies;      ///< omega, rad/s, ascending; 0 for rigid motion
  Eigen::MatrixXd shapes;  ///< Phi, n x p; the largest displacement of each is positive
  /// |(K - s M)^-1 M phi_i - phi_i / (omega_i^2 - s)|_M |omega_i^2 - s| with the shift s < 0: a
  /// bound on the relative distance of omega_i^2 - s from an eigenvalue.
  Vector residuals;
  /// Relative uncertainty of omega_i from rounding in the elements and the shapes; 0 for rigid
  /// motion.
  Vector rounding;
  Index rigid = 0;     ///< number of modes that are rigid motion, or motion of a mechanism
  double shift = 0.0;  ///< s, 1/s2
  bool dense = false;  ///< all eigenvalues were computed; otherwise Lanczos' method was used
};

/// The `count` lowest modes, 1 <= count <= n.
///
/// Small systems are solved densely, all others by Lanczos' method on (K - s M)^-1 M with a shift s
/// a little below zero, so that rigid motion is a mode like any other. The signs of pivots
/// (Sylvester) choose the shift and then count the eigenvalues below the last one; if Lanczos
/// missed some of several equal ones, the search is repeated outside the span of those found. A
/// Rayleigh-Ritz step with elastic forces summed element by element refines the last digits of the
/// frequencies.
///
/// Checked in tests/unit/modes_test.cpp against closed forms, to 1e5 DOFs. Throws InputError if so
/// many modes do not fit into memory. Sources: T. Ericsson, A. Ruhe, The spectral transformation
/// Lanczos method, Mathematics of Computation 35 (1980), doi:10.1090/S0025-5718-1980-0583502-2;
/// K.-J. Bathe, Finite Element Procedures, 1996, chapter 11.
BUTEE_EXPORT NaturalModes find_modes(const Structure& structure, Index count);

}  // namespace butee::dynamics

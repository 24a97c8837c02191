#pragma once

#include <string>

#include "butee/dynamics/structure.hpp"

namespace butee::dynamics {

/// The lowest natural modes of a structure without damping: K phi_i = omega_i^2 M phi_i, Phi^T M Phi = 1.
struct NaturalModes {
  std::string problem;     ///< why there are none; empty where all went well
  Vector frequencies;      ///< omega, rad/s, ascending; 0 for rigid motion
  Eigen::MatrixXd shapes;  ///< Phi, n x p; the largest displacement of each is positive
  /// |(K - s M)^-1 M phi_i - phi_i / (omega_i^2 - s)|_M |omega_i^2 - s| with the shift s < 0: so far, relative, may
  /// omega_i^2 - s be from an eigenvalue's.
  Vector residuals;
  /// What rounding in the elements and the shapes may change in omega_i, relative; 0 for rigid motion.
  Vector rounding;
  Index rigid = 0;     ///< modes of rigid motion, or of a mechanism, among them
  double shift = 0.0;  ///< s, 1/s2
  bool dense = false;  ///< all eigenvalues were computed; else by Lanczos' method
};

/// The `count` lowest modes, 1 <= count <= n.
///
/// Small systems are solved densely, all others by Lanczos' method on (K - s M)^-1 M with a shift s a little below
/// zero, so that rigid motion is a mode like any other. Pivots' signs (Sylvester) choose the shift and then count the
/// eigenvalues below the last one; what Lanczos missed of several equal ones is looked for again beside those found.
/// A Rayleigh-Ritz step with elastic forces summed element by element gives the frequencies their last digits.
///
/// Checked in tests/unit/modes_test.cpp against closed forms, to 1e5 DOFs. Throws InputError where so many modes do not
/// fit into memory. Sources: T. Ericsson, A. Ruhe, The spectral transformation Lanczos method, Mathematics of
/// Computation 35 (1980), doi:10.1090/S0025-5718-1980-0583502-2; K.-J. Bathe, Finite Element Procedures, 1996, chapter
/// 11.
BUTEE_EXPORT NaturalModes find_modes(const Structure& structure, Index count);

}  // namespace butee::dynamics

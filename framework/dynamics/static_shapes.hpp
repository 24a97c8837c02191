#pragma once

#include "butee/dynamics/frequencies.hpp"

namespace butee::dynamics {

/// Private to this folder: the response of the modes omitted from a truncated basis to given
/// forces, without their inertia.
///
/// Adds to the lowest modes the static displacements under the columns of `forces` (n x k), made
/// orthogonal to those modes and to each other by a Rayleigh-Ritz step: Phi^T M Phi stays 1 and
/// Phi^T K Phi diagonal, and the basis contains every static response to those forces. Linearly
/// dependent displacements are omitted. A weak spring to ground on every DOF, 1e-4 of the last
/// mode's stiffness, allows rigid motion; it changes the static response by as much. Checked in
/// tests/unit/static_shapes_test.cpp.
///
/// Returns, for each force, the fraction of the displacement along itself that the omitted modes
/// contribute. Empty, with `modes` unchanged, if the linear system or the small eigenproblem could
/// not be solved.
///
/// Sources: R. H. MacNeal, Computers and Structures 1 (1971) 581-601, doi:10.1016/0045-7949(71)90031-9; S. Rubin, AIAA
/// Journal 13 (1975) 995-1006, doi:10.2514/3.60497.
BUTEE_EXPORT Vector add_static_shapes(const model::System& system, const Eigen::MatrixXd& forces, Modes& modes);

}  // namespace butee::dynamics

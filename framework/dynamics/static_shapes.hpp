#pragma once

#include "butee/dynamics/frequencies.hpp"

namespace butee::dynamics {

/// Private to this folder: what the modes left out of a truncated basis do under given forces, as if they had no
/// inertia.
///
/// Adds to the lowest modes the static displacements under the columns of `forces` (n x k), freed of those modes and
/// made modes of their own by a Rayleigh-Ritz step: Phi^T M Phi stays 1 and Phi^T K Phi diagonal, and with them the
/// basis holds every static response to those forces. Displacements that depend on the others are left out. A weak
/// spring to the ground on every DOF, 1e-4 of the last mode's stiffness, lets rigid motion pass; it makes the static
/// response wrong by as much. Checked in tests/unit/static_shapes_test.cpp.
///
/// Returns, for each force, the part of the displacement along itself that the modes left out carry. Empty, and
/// `modes` as they were, where the linear system or the small eigenproblem could not be solved.
///
/// Sources: R. H. MacNeal, Computers and Structures 1 (1971) 581-601, doi:10.1016/0045-7949(71)90031-9; S. Rubin, AIAA
/// Journal 13 (1975) 995-1006, doi:10.2514/3.60497.
BUTEE_EXPORT Vector add_static_shapes(const model::System& system, const Eigen::MatrixXd& forces, Modes& modes);

}  // namespace butee::dynamics

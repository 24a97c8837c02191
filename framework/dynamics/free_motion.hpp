#pragma once

#include <string>

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The degrees of freedom that take part in a motion, largest first: "u of a, u of b and 3 more".
/// Displacements and rotations are compared separately; rotations are named only if no displacement
/// occurs.
BUTEE_EXPORT std::string describe_motion(ConstVectorRef shape, const model::DofTable& dofs);

/// The same for the motion with the least resistance of a symmetric matrix, each degree of freedom
/// weighted by its diagonal entry.
BUTEE_EXPORT std::string describe_softest_motion(const SparseMatrix& matrix, const model::DofTable& dofs);

}  // namespace butee::dynamics

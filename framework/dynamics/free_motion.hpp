#pragma once

#include <string>

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The degrees of freedom that take part in a motion, the largest first: "u of a, u of b and 3 more". Displacements and
/// rotations are compared among themselves; rotations are named where nothing else moves.
BUTEE_EXPORT std::string describe_motion(ConstVectorRef shape, const model::DofTable& dofs);

/// The same for the motion that a symmetric matrix resists least, each degree of freedom weighed by its diagonal.
BUTEE_EXPORT std::string describe_softest_motion(const SparseMatrix& matrix, const model::DofTable& dofs);

}  // namespace butee::dynamics

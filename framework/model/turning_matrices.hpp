#pragma once

#include <span>

#include "butee/model/element.hpp"

namespace butee::model {

/// W = -D J per rad/s for rotating damping D on `dofs`; J x is the cross product of e_x with the
/// displacements and rotations of each node.
BUTEE_EXPORT Eigen::MatrixXd circulatory_of(std::span<const NodalDof> dofs, const Eigen::MatrixXd& damping);

}  // namespace butee::model

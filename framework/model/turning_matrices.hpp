#pragma once

#include <span>

#include "butee/model/element.hpp"

namespace butee::model {

/// W = -D J per rad/s for rotating damping D on `dofs`; J x is the cross product of e_x with the
/// displacements and rotations of each node.
BUTEE_EXPORT Eigen::MatrixXd circulatory_of(std::span<const NodalDof> dofs, const Eigen::MatrixXd& damping);

/// The damping that turns with an element: its own or, where it has none, `proportional` (s) times its stiffness. The
/// stiffness of a bearing or spring with rotating damping stands still, and may differ between the axes.
BUTEE_EXPORT Eigen::MatrixXd rotating_damping_of(const ElementMatrices& matrices, double proportional);

}  // namespace butee::model

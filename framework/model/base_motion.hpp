#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "butee/model/dofs.hpp"
#include "butee/model/smooth_motion.hpp"

namespace butee::model {

struct Model;

/// A motion of all or some supports along one direction.
struct BaseMotion {
  Eigen::Vector3d direction;  ///< of length 1
  /// Displacement (m), velocity and acceleration; empty if they are not known in closed form.
  std::optional<std::array<SmoothMotion, 3>> motion;
  std::vector<NodeId> nodes;  ///< nodes whose fixed displacements follow it; empty: all, and the ground
};

/// The reference of x in a scene with base motion.
///
/// moving: x is relative to the base, whose acceleration acts as -M r; stops to ground move with
/// the base. still: x is absolute; supports s and ground that all move by r D act as C_ff r D' +
/// K_ff r D - M_fs r D'', and some supports as -(M_fs D'' + C_fs D' + K_fs D), on the free degrees
/// of freedom f.
enum class BaseFrame { moving, still };

/// True if supports move one by one, so that u is the displacement in space.
bool moves_apart(const std::vector<BaseMotion>& bases);

/// The contribution of a base motion to an output: factor times displacement, velocity or
/// acceleration.
struct BaseShare {
  const SmoothMotion* motion;
  double factor;
};

/// The terms to add to x, v or a (order 0, 1, 2) of a DOF, 0 if it is fixed, to get its value
/// relative to the base (u; the absolute one if single supports move) or, with `absolute`, in
/// space.
BUTEE_EXPORT std::vector<BaseShare> base_shares(const Model& model, const DofTable& dofs, NodalDof dof, int order,
                                                bool absolute);

/// The motion of all free DOFs with the base, in x, v or a (order 0, 1, 2): what they have in space beside their motion
/// relative to the base. Zero unless x is a motion in space (BaseFrame::still).
BUTEE_EXPORT Vector motion_with_base(const Model& model, const DofTable& dofs, int order, double t);

/// True if every base motion that affects x is known in closed form.
BUTEE_EXPORT bool knows_base_motion(const Model& model);

/// M s, C s and K s on the free DOFs, where C is the damping of the model without modal damping. s
/// are the fixed displacements of some nodes. For a translation of everything (`nodes` empty) M s
/// is that of the fixed displacements, and C s and K s are those of the free ones.
struct PrescribedForces {
  std::vector<NodalValue> mass, damping, stiffness;
};

/// True for a fixed displacement that a base moves.
BUTEE_EXPORT bool moves_with_base(const Model& model, const DofTable& dofs, NodalDof dof);

/// A node with a fixed displacement that moves with a base, where a part that turns has gyroscopic or rotating-damping
/// terms of that displacement: prescribed_forces() lacks these.
BUTEE_EXPORT std::optional<NodeId> turning_support(const Model& model, const DofTable& dofs);

BUTEE_EXPORT PrescribedForces prescribed_forces(const Model& model, const DofTable& dofs,
                                                const Eigen::Vector3d& direction, const std::vector<NodeId>& nodes);

}  // namespace butee::model

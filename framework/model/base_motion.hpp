#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "butee/model/dofs.hpp"
#include "butee/model/smooth_motion.hpp"

namespace butee::model {

struct Model;

/// A motion of all supports, or of some, along one direction.
struct BaseMotion {
  Eigen::Vector3d direction;  ///< of length 1
  /// Displacement (m), velocity and acceleration; nothing where they are not known in closed form.
  std::optional<std::array<SmoothMotion, 3>> motion;
  std::vector<NodeId> nodes;  ///< whose fixed displacements follow it; empty: all, and the ground
};

/// What x of a scene with base motion is measured from.
///
/// moving: x is relative to the base, whose acceleration acts as -M r. Stops to ground move with it. still: x is
/// absolute; supports s and ground that move by r D all together act as C_ff r D' + K_ff r D - M_fs r D'', and some
/// supports as -(M_fs D'' + C_fs D' + K_fs D), on the free degrees of freedom f.
enum class BaseFrame { moving, still };

/// A motion of the base in an output: factor times displacement, velocity or acceleration.
struct BaseShare {
  const SmoothMotion* motion;
  double factor;
};

/// What is to be added to x, v or a (order 0, 1, 2) of a DOF, 0 where it is fixed, for its value relative to the base
/// (u; where single supports move, the absolute one) or, with `absolute`, in space.
BUTEE_EXPORT std::vector<BaseShare> base_shares(const Model& model, const DofTable& dofs, NodalDof dof, int order,
                                                bool absolute);

/// True where every motion of the base that concerns x is known in closed form.
BUTEE_EXPORT bool knows_base_motion(const Model& model);

/// M s, C s and K s on the free DOFs, with C the damping of the model but modal one. s are the fixed displacements of
/// some nodes; of a translation of everything (`nodes` empty) M s is that of the fixed displacements, C s and K s are
/// those of the free ones.
struct PrescribedForces {
  std::vector<NodalValue> mass, damping, stiffness;
};

BUTEE_EXPORT PrescribedForces prescribed_forces(const Model& model, const DofTable& dofs,
                                                const Eigen::Vector3d& direction, const std::vector<NodeId>& nodes);

}  // namespace butee::model

#pragma once

#include <Eigen/Core>

#include "butee/core/types.hpp"

namespace butee::dynamics {

// Natural modes far slower than the fastest one: the eigenvalue solver leaves the rounding of the fastest in their
// frequencies and shapes. `squares` are the squares of all frequencies, ascending, rad2/s2; column i of `shapes` is
// mode i. Theory: plugins/exponential/COLLOCATION.md, section 1.

/// phi^T K phi below this part of epsilon |phi|^T |K| |phi| is rounding of the entries of K: at most 0.14 of it for
/// rigid motion of beams with uneven meshes (RigidMotion.OfUnevenMeshesIsFound), (m - 1)/8 where m springs meet.
constexpr double kRoundingOfEntries = 0.5;

/// The number of modes that do not oscillate within a run of `run_time` seconds or whose frequency is rounding.
Index count_rigid(const Vector& squares, double run_time);

/// Turns the first `count` shapes, those of rigid motion, and the damping with them, such that motions on which no
/// damping and no gyroscopic moment acts are shapes of their own: the common motion of two bodies joined by a dashpot,
/// the translation of a free rotor. They have no basis of eigenvectors, and would leave none to shapes that they share.
/// Rounding of the shapes leaves some damping on them, which would join them to all other modes; it is set to 0 if
/// it does not act within `run_time` seconds. False if nothing couples the shapes.
bool separate_rigid(Index count, double run_time, Eigen::MatrixXd& shapes, Eigen::MatrixXd& damping);

/// The number of modes whose omega^2 the rounding of the eigenvalues beside the `highest` one leaves with less than
/// nine digits.
Index count_soft(ConstVectorRef squares, double highest);

/// S^T A S of the first `count` shapes S, to rounding of the entries of A.
Eigen::MatrixXd soft_product(Index count, const SparseMatrix& matrix, const Eigen::MatrixXd& shapes);

/// S^T K S of the first `count` shapes S, those of rigid and soft motion, to rounding of the entries of K. The
/// eigenvalues and shapes alone have the rounding of the highest eigenvalue, which would turn shapes of similar
/// frequency into one another, and move a free body by kappa t^2/6 of its way if kappa is the error of omega^2. Entries
/// that are rounding of K, or turn no shape by more than 1e-9, are 0; so are those of the diagonal that are below 0 by
/// rounding or do not act within `run_time` seconds or, if that is infinite, are not above kRoundingOfEntries.
Eigen::MatrixXd soft_stiffness(Index count, double run_time, const SparseMatrix& stiffness,
                               const Eigen::MatrixXd& shapes);

}  // namespace butee::dynamics

#pragma once

#include <optional>

#include <Eigen/Core>

#include "butee/dynamics/structure.hpp"

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

/// S^T K S of shapes S of rigid and soft motion, to rounding of the entries of K or, where that is not enough, of those
/// of the elements. The eigenvalues and shapes alone have the rounding of the highest eigenvalue, which would turn
/// shapes of similar frequency into one another, and move a free body by kappa t^2/6 of its way if kappa is the error
/// of omega^2.
class SoftStiffness {
 public:
  /// `stiffness` is K, and `system` the one whose model has its elements; both must outlive this object.
  SoftStiffness(const SparseMatrix& stiffness, const model::System& system, double run_time)
      : stiffness_(stiffness), system_(system), run_time_(run_time) {}

  /// Returns the product of the first `count` shapes. Entries that are rounding, or turn no shape by more than 1e-9,
  /// are 0; so are those of the diagonal that are below 0 by rounding or do not act within the run time or, if that is
  /// infinite, are not above rounding.
  Eigen::MatrixXd of(Index count, const Eigen::MatrixXd& shapes);
  /// The rounding of the diagonal of the last product.
  const Vector& rounding() const { return rounding_; }

 private:
  /// Whether the elements can replace K, which has no terms of other origin. Summed by element, a motion without strain
  /// has no rounding.
  bool has_elements();

  const SparseMatrix& stiffness_;
  const model::System& system_;
  double run_time_;
  Vector rounding_;
  std::optional<Structure> structure_;
  bool has_tried_ = false;
};

}  // namespace butee::dynamics

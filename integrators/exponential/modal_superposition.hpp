#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "butee/dynamics/damped_modes.hpp"
#include "integrators/exponential/lanes.hpp"

namespace butee::integrators {

/// The displacements and velocities of chosen DOFs from the coordinates of damped modes, and the modal forces of forces
/// on these DOFs: products with the matrices of dynamics::DampedModes.
///
/// The products go through the natural modes if that takes fewer multiplications. A natural mode moves only DOFs that
/// the matrices of mass and stiffness join, for example those of one plane, and a damped mode of a small block combines
/// few natural modes: for a uniform shaft that takes a quarter of the multiplications.
class ModalSuperposition {
 public:
  /// `modes` must outlive it. Begins without DOFs.
  explicit ModalSuperposition(const dynamics::DampedModes& modes) : modes_(modes) {}

  /// Sets the DOFs; rows of motion and forces are in this order.
  void choose(const std::vector<Index>& dofs);
  Index count() const { return count_; }
  bool goes_by_natural_modes() const { return !parts_.empty(); }

  /// x := displacements, for z with 2p rows.
  void displacements(const Lanes& z, Lanes& x);
  /// v := velocities
  void velocities(const Lanes& z, Lanes& v);
  /// Fills the columns of `out` with the displacements of two motions, 2p numbers each, and with their velocities.
  void motions(const Eigen::VectorXd& one, const Eigen::VectorXd& other, LanesOf<4>& out);
  /// rates := what the forces `f` (a row for each DOF) add to dz/dt, 2p rows
  void modal_forces(const Lanes& f, Lanes& rates);

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// DOFs that natural modes move together.
  struct Part {
    std::vector<Index> modes;  ///< natural modes
    std::vector<Index> rows;   ///< places of its chosen DOFs
    Rows shapes;               ///< rows x modes
  };
  using Combination = Eigen::SparseMatrix<double>;

  void superpose(const Combination& natural, const Rows& direct, const Lanes& z, Lanes& out);

  const dynamics::DampedModes& modes_;
  Index count_ = 0;
  std::vector<Part> parts_;                          ///< empty: products with the matrices themselves
  Rows displacement_, velocity_, input_;             ///< count x 2p, count x 2p, 2p x count; only without parts
  Eigen::SparseMatrix<double, Eigen::RowMajor> in_;  ///< 2p x n: modal forces from those on natural modes
  Lanes natural_, moved_;
  LanesOf<4> pairs_;
};

}  // namespace butee::integrators

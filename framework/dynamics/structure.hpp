#pragma once

#include <optional>
#include <vector>

#include "butee/linalg/extended.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

/// A closed stop, treated as a spring between nodes a and b, or a and the ground.
struct ClosedStop {
  static constexpr model::NodeId kGround = -1;
  model::NodeId a = 0, b = kGround;
  double stiffness = 0.0;  ///< N/m or N m/rad
  DofKind dof = DofKind::u;
};

/// M and K of a model without its loads, damping and open stops, summed in extended precision.
///
/// The lowest eigenvalue of a beam of N elements is about N^-4 of the highest, so that sums in
/// double precision lose it from some thousand elements on. The element matrices themselves do not:
/// their stiffness is exact for a translation and good to rounding for a rotation. So matrices are
/// summed in long double, and elastic forces element by element with the element's translation
/// removed first.
class BUTEE_EXPORT Structure {
 public:
  /// `model` must outlive this object; `dofs` is that of the model's System.
  Structure(const model::Model& model, const model::DofTable& dofs, std::vector<ClosedStop> closed = {});

  /// The structure of system.model if `stiffness` is the sum of its elements to rounding; it may have parts of other
  /// origin, as bearings at a speed, or changes by a program.
  static std::optional<Structure> of(const model::System& system, const SparseMatrix& stiffness);

  Index size() const { return mass_.rows(); }
  const linalg::ExtendedMatrix& mass() const { return mass_; }            ///< n x n, kg ...
  const linalg::ExtendedMatrix& stiffness() const { return stiffness_; }  ///< n x n, N/m ..., with the closed stops
  /// The forces on the free DOFs if every node, including held ones, is accelerated by 1 m/s2 along
  /// u: M r, kg or kg m.
  const Vector& carried() const { return carried_; }
  /// The mass that moves along u, r^T M r, kg, including mass on held nodes.
  double total_mass() const { return total_mass_; }

  /// Elastic forces of displacements and, if asked for, the uncertainty of x^T K x from rounding in
  /// the elements and in x.
  struct Elastic {
    linalg::ExtendedColumns forces;  ///< K x, n x p
    Vector rounding;                 ///< p, J
  };
  Elastic elastic(const Eigen::MatrixXd& x, bool with_rounding = false) const;

 private:
  void visit(model::MatrixSink& sink) const;

  const model::Model& model_;
  const model::DofTable& dofs_;
  std::vector<ClosedStop> closed_;
  linalg::ExtendedMatrix mass_, stiffness_;
  Vector carried_;
  double total_mass_ = 0.0;
};

}  // namespace butee::dynamics

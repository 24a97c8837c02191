#pragma once

#include <memory>

#include "butee/linalg/low_rank.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

/// Damping by the modes of the undamped system with open stops: mode i decays with the ratio
/// zeta_i, independently of the others.
///
///     C = M Phi diag(2 zeta_i omega_i) Phi^T M = B B^T,    B = M Phi diag(sqrt(2 zeta_i omega_i)),    Phi^T M Phi = 1
///
/// B is n x p for p damped modes, so that C v costs 4 n p operations. Rigid motion (omega = 0) is
/// not damped. If only some of several modes of one frequency are damped, C depends on the shapes
/// that the eigenvalue solver chose. Checked in tests/unit/modal_damping_test.cpp. Source: E. L.
/// Wilson, J. Penzien, Evaluation of orthogonal damping matrices, International Journal for
/// Numerical Methods in Engineering 4 (1972), doi:10.1002/nme.1620040102.
class BUTEE_EXPORT ModalDamping {
 public:
  /// Made from the system's Damping; null if it has none or no mode remains to be damped. Throws
  /// InputError if the modes could not be computed or are too many, or a list gives a ratio to
  /// rigid motion.
  static std::unique_ptr<const ModalDamping> of(const model::System& system);

  /// y += C v, N or N m
  void add_force(ConstVectorRef v, VectorRef y) const;
  /// a -= M^-1 C v
  void subtract_deceleration(ConstVectorRef v, VectorRef a) const;
  /// C of a system with one DOF, N s/m
  double single() const { return factor().row(0).squaredNorm(); }

  /// B, n x p
  const Eigen::MatrixXd& factor() const { return matrix_.factor(); }
  /// C
  const linalg::LowRank& matrix() const { return matrix_; }

 private:
  ModalDamping(const model::System& system, const Eigen::MatrixXd& shapes);

  Eigen::MatrixXd shapes_;  ///< Phi diag(sqrt(2 zeta_i omega_i)), n x p
  linalg::LowRank matrix_;
  mutable Vector modal_;
};

}  // namespace butee::dynamics

#pragma once

#include <functional>
#include <memory>

#include <Eigen/Cholesky>

#include "butee/model/system.hpp"

namespace butee::solve {

/// Damping by the modes of the undamped system, its stops open: mode i alone decays with the ratio zeta_i.
///
///     C = M Phi diag(2 zeta_i omega_i) Phi^T M = B B^T,    B = M Phi diag(sqrt(2 zeta_i omega_i)),    Phi^T M Phi = 1
///
/// B is n x p for p damped modes, so that C v costs 4 n p operations. Rigid motion (omega = 0) is not damped. Where
/// only some of several modes of one frequency are damped, C depends on which shapes the eigenvalue solver chose.
/// Checked in tests/unit/modal_damping_test.cpp. Source: E. L. Wilson, J. Penzien, Evaluation of orthogonal damping
/// matrices, International Journal for Numerical Methods in Engineering 4 (1972), doi:10.1002/nme.1620040102.
class BUTEE_EXPORT ModalDamping {
 public:
  /// Of the system's Damping; null where it has none or no mode is left to damp. Throws InputError where the modes
  /// could not be computed or are too many, or a list gives a ratio to rigid motion.
  static std::unique_ptr<const ModalDamping> of(const model::System& system);

  /// y += C v, N or N m
  void add_force(ConstVectorRef v, VectorRef y) const;
  /// a -= M^-1 C v
  void subtract_deceleration(ConstVectorRef v, VectorRef a) const;
  /// A += c C
  void add_to(Eigen::MatrixXd& matrix, double c) const;
  /// C of a system of one DOF, N s/m
  double single() const { return factor_.row(0).squaredNorm(); }

  /// B, n x p
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// So many modes are damped that the full matrix is the better way.
  bool prefers_dense() const { return 2 * factor_.cols() >= factor_.rows(); }

 private:
  ModalDamping(const model::System& system, const Eigen::MatrixXd& shapes);

  Eigen::MatrixXd shapes_;  ///< Phi diag(sqrt(2 zeta_i omega_i)), n x p
  Eigen::MatrixXd factor_;
  mutable Vector modal_;
};

/// Corrects a solution of A y = b for modal damping by Woodbury's formula:
///
///     (A + c B B^T) x = b,    x = y - Z c (1 + c B^T Z)^-1 B^T y,    Z = A^-1 B
///
/// Allocates nothing after set(). Source: W. W. Hager, Updating the inverse of a matrix, SIAM Review 31 (1989),
/// doi:10.1137/1031049.
class ModalUpdate {
 public:
  /// `damping` must outlive it.
  explicit ModalUpdate(const ModalDamping& damping) : damping_(damping) {}

  /// Takes a new A, which `solve` divides by in place, and c >= 0 (s). False where the small matrix is not positive
  /// definite.
  [[nodiscard]] bool set(double c, const std::function<void(VectorRef)>& solve);
  /// y := x
  void correct(VectorRef y);

 private:
  const ModalDamping& damping_;
  double c_ = 0.0;
  Eigen::MatrixXd solved_;  ///< Z
  Eigen::LLT<Eigen::MatrixXd> small_;
  Vector modal_;
};

/// A dense Cholesky factorization that solves in place, for matrices too large for an inverse.
class DenseFactor {
 public:
  [[nodiscard]] bool factorize(const Eigen::MatrixXd& matrix) {
    factor_.compute(matrix);
    return factor_.info() == Eigen::Success;
  }
  void solve(VectorRef b) const { factor_.solveInPlace(b); }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace butee::solve

#pragma once

#include <functional>

#include <Eigen/Cholesky>
#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::linalg {

/// A symmetric positive semidefinite matrix, given by a factor of few columns: C = B B^T, B n x p.
class BUTEE_EXPORT LowRank {
 public:
  explicit LowRank(Eigen::MatrixXd factor) : factor_(std::move(factor)) {}

  /// B, n x p
  const Eigen::MatrixXd& factor() const { return factor_; }
  /// A += c C
  void add_to(Eigen::MatrixXd& matrix, double c) const;
  /// True if B has so many columns that the full matrix is cheaper.
  bool prefers_dense() const { return 2 * factor_.cols() >= factor_.rows(); }

 private:
  Eigen::MatrixXd factor_;
};

/// Corrects a solution of A y = b for a low-rank term by Woodbury's formula:
///
///     (A + c B B^T) x = b,    x = y - Z c (1 + c B^T Z)^-1 B^T y,    Z = A^-1 B
///
/// Allocates nothing after set(). Source: W. W. Hager, Updating the inverse of a matrix, SIAM Review 31 (1989),
/// doi:10.1137/1031049.
class LowRankUpdate {
 public:
  /// `term` must outlive this object.
  explicit LowRankUpdate(const LowRank& term) : term_(term) {}

  /// Sets a new A, whose inverse `solve` applies in place, and c >= 0 (s). False if the small
  /// matrix is not positive definite.
  [[nodiscard]] bool set(double c, const std::function<void(VectorRef)>& solve);
  /// Corrects in place: y := x
  void correct(VectorRef y);

 private:
  const LowRank& term_;
  double c_ = 0.0;
  Eigen::MatrixXd solved_;  ///< Z
  Eigen::LLT<Eigen::MatrixXd> small_;
  Vector work_;  ///< B^T y
};

/// A dense Cholesky factorization that solves in place, for matrices too large for an inverse.
class DenseFactor {
 public:
  [[nodiscard]] bool factorize(const Eigen::MatrixXd& matrix);
  void solve(VectorRef b) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace butee::linalg

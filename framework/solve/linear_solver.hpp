#pragma once

#include <optional>

#include "butee/solve/dense_product.hpp"
#include "butee/solve/symmetric_factor.hpp"

namespace butee::solve {

/// Solves A x = b for a symmetric positive definite A: small ones by their dense inverse, which costs one dense
/// product, all others by sparse Cholesky. The choice depends on the size alone. Allocates nothing after the first
/// solve.
class BUTEE_EXPORT LinearSolver {
 public:
  /// Systems up to this size are inverted.
  static constexpr Index kLargestInverse = DenseProduct::kMostRows;

  /// Analyses the pattern of `matrix`; `counters` must outlive the solver.
  LinearSolver(const SparseMatrix& matrix, Counters& counters);

  /// False where the matrix is not positive definite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);

  /// b := A^-1 b. After a successful factorize().
  void solve(VectorRef b);

  /// A^-1 of a small system, else 0 x 0.
  const Eigen::MatrixXd& inverse() const { return inverse_; }

 private:
  Counters* counters_;
  std::optional<SymmetricFactor> factor_;
  Eigen::MatrixXd inverse_;
  DenseProduct product_;
  Vector right_;
};

}  // namespace butee::solve

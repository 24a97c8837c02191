#pragma once

#include <optional>

#include "butee/solve/band_factor.hpp"
#include "butee/solve/dense_product.hpp"
#include "butee/solve/symmetric_factor.hpp"

namespace butee::solve {

/// Solves A x = b for a symmetric positive definite A: tiny and small ones without a narrow band by their inverse, which
/// costs one dense product, narrow bands from both ends, all others by sparse Cholesky (CHOLMOD). The choice depends on
/// the pattern alone. Allocates nothing after the first solve.
class BUTEE_EXPORT LinearSolver {
 public:
  /// Systems up to this size are inverted; with a narrow band only those up to kTiny.
  static constexpr Index kLargestInverse = DenseProduct::kMostRows;
  static constexpr Index kTiny = 16;

  /// Analyses the pattern of `matrix`; `counters` must outlive the solver.
  LinearSolver(const SparseMatrix& matrix, Counters& counters);

  /// False where the matrix is not positive definite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);

  /// b := A^-1 b. After a successful factorize().
  void solve(VectorRef b);

 private:
  Counters* counters_;
  std::optional<SymmetricFactor> factor_;
  std::optional<BandFactor> band_;
  double reciprocal_ = 0.0;  ///< of a single equation
  DenseProduct inverse_;
  Vector right_;
};

}  // namespace butee::solve

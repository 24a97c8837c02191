#pragma once

#include <memory>
#include <optional>

#include "butee/linalg/band_factor.hpp"
#include "butee/linalg/dense_product.hpp"
#include "butee/linalg/general_factor.hpp"
#include "butee/linalg/low_rank.hpp"
#include "butee/linalg/symmetric_factor.hpp"

namespace butee::linalg {

/// Solves A x = b for a symmetric positive definite A, or a general one of symmetric pattern. Tiny
/// systems, and small ones without a narrow band, use their inverse, which costs one dense product;
/// narrow bands use BandFactor; all others sparse Cholesky (CHOLMOD), or sparse LU (KLU) if A is
/// general and not small. The choice depends only on the pattern and the symmetry. Allocates
/// nothing after the first solve.
///
/// With a low-rank term, as for modal damping, A = sparse part + c C: small systems and terms of
/// many columns are solved densely, terms of few columns by the sparse factor and Woodbury's
/// formula.
class BUTEE_EXPORT LinearSolver {
 public:
  /// Systems up to this size are inverted; with a narrow band only up to kTiny.
  static constexpr Index kLargestInverse = DenseProduct::kMostRows;
  static constexpr Index kTiny = 16;

  /// Analyses the pattern of `matrix`; `counters` and `term`, the C below or null, must outlive the
  /// solver. A matrix that is not symmetric must have no C.
  LinearSolver(const SparseMatrix& matrix, Counters& counters, const LowRank* term = nullptr, bool is_symmetric = true);

  /// Factorizes `matrix` + c C. False if that, or `matrix`, is not positive definite or, for a
  /// matrix that is not symmetric, singular.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix, double c = 0.0);

  /// b := A^-1 b. Valid after a successful factorize().
  void solve(VectorRef b);
  /// b := A^-1 b - factor v
  void solve_less(VectorRef b, double factor, ConstVectorRef v);

 private:
  bool factorize_sparse(const SparseMatrix& matrix);
  bool factorize_dense(const SparseMatrix& matrix, double c);
  void solve_sparse(VectorRef b);

  Counters* counters_;
  const LowRank* term_;
  bool is_symmetric_;
  std::optional<SymmetricFactor> factor_;
  std::optional<GeneralFactor> general_;
  std::optional<BandFactor> band_;
  double reciprocal_ = 0.0;  ///< for a single equation
  DenseProduct inverse_;
  Vector right_;
  std::unique_ptr<DenseFactor> dense_;       ///< for large systems whose term has many columns
  std::unique_ptr<LowRankUpdate> low_rank_;  ///< for terms with few columns
};

}  // namespace butee::linalg

#pragma once

#include <memory>

#include <butee/export.hpp>

#include "butee/core/types.hpp"
#include "butee/linalg/counters.hpp"

namespace butee::linalg {

/// A sparse Cholesky factorization (CHOLMOD), analysed once, factorized for many matrices of one pattern.
///
/// A is stored as P^T L D L^T P. Chains keep their natural order; all other patterns get an
/// approximate minimum degree ordering. Beams and springs cause so little fill-in that columns are
/// never gathered into supernodes. solve() substitutes in place, without allocating.
class BUTEE_EXPORT SymmetricFactor {
 public:
  /// Analyses the pattern of `matrix` (symmetric, stored in full). `counters` must outlive the factor.
  SymmetricFactor(const SparseMatrix& matrix, Counters& counters);
  ~SymmetricFactor();
  SymmetricFactor(SymmetricFactor&&) noexcept;
  SymmetricFactor& operator=(SymmetricFactor&&) noexcept;

  /// Factorizes a matrix of the analysed pattern; false if it is not positive definite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);

  /// b := A^-1 b. Valid after a successful factorize().
  void solve(VectorRef b);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace butee::linalg

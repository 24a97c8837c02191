#pragma once

#include <memory>

#include <butee/export.hpp>

#include "butee/core/types.hpp"
#include "butee/linalg/counters.hpp"

namespace butee::linalg {

/// A sparse LU factorization with partial pivoting (KLU) for matrices that are not symmetric:
/// analysed once, factorized for many matrices of one pattern. Its pivots depend on the matrix
/// alone, not on earlier factorizations.
class BUTEE_EXPORT GeneralFactor {
 public:
  /// Analyses the pattern of `matrix`. `counters` must outlive the factor.
  GeneralFactor(const SparseMatrix& matrix, Counters& counters);
  ~GeneralFactor();
  GeneralFactor(GeneralFactor&&) noexcept;
  GeneralFactor& operator=(GeneralFactor&&) noexcept;

  /// Factorizes a matrix of the analysed pattern; false if it is singular to rounding.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);

  /// b := A^-1 b. Valid after a successful factorize().
  void solve(VectorRef b);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace butee::linalg

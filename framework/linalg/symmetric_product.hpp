#pragma once

#include <memory>

#include <butee/export.hpp>

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg {

namespace kernel {
struct BandMatrix;
struct Rows;
}  // namespace kernel

/// y = A x for a sparse A of symmetric pattern. Narrow bands, as of chains of beams, are stored by
/// diagonals, which needs no indices and vectorises; all other matrices by rows. Equal rows of
/// large matrices are stored once. Allocates nothing after construction.
class BUTEE_EXPORT SymmetricProduct {
 public:
  SymmetricProduct() = default;
  /// Takes a symmetric matrix stored in full; if stored by rows, the object refers to `matrix`,
  /// which must outlive it. A matrix that is not symmetric is copied.
  explicit SymmetricProduct(const SparseMatrix& matrix, bool is_symmetric = true);

  /// A(0, 0)
  double first() const { return first_; }
  /// y := A x; x and y have size() and must not overlap.
  void multiply(const double* x, double* y) const {
    if (size_ == 1)
      y[0] = first_ * x[0];
    else
      multiply(x, 0, size_, y);
  }
  /// y := rows begin to begin + count of A x, into y[0] to y[count - 1]: all rows, or blocks as cut
  /// by in_blocks().
  void multiply(const double* x, Index begin, Index count, double* y) const;

 private:
  void multiply_band(const double* x, Index begin, Index count, double* y) const;
  void share_rows();
  void multiply_rows(const double* x, Index begin, Index count, double* y) const;

  void (*kernel_)(const kernel::BandMatrix&, kernel::Rows, const double*, double*) = nullptr;
  Index size_ = 0, band_ = 0;
  double first_ = 0.0;
  const SparseMatrix* rows_ = nullptr;
  std::unique_ptr<const SparseMatrix> transposed_;  ///< target of rows_ if A is not symmetric
  /// A(i, i + k) and A(i, i - k), one diagonal k = 0 ... band after the other, stride_ entries
  /// apart, with zeros around. Empty if A is stored by rows; below_ is also empty for large
  /// matrices.
  Vector above_, below_;
  Index stride_ = 0;
  /// Used instead if it saves much memory: for each chunk of rows, and for the last two chunks
  /// again as they end the matrix, diagonals k = 0 ... band above and 1 ... band below.
  ChunkTable chunks_;
};

/// The largest distance of an entry from the diagonal.
Index bandwidth(const SparseMatrix& matrix);

}  // namespace butee::linalg

#pragma once

#include "butee/core/types.hpp"

namespace butee::linalg::kernel {

/// Number of doubles to which the columns of matrices, the blocks of stops and the chunks of rows
/// are padded for every instruction set: the widest register.
inline constexpr Index kChunk = 8;

/// Number of whole chunks that hold `size` doubles.
constexpr Index chunks_for(Index size) {
  return (size + kChunk - 1) / kChunk;
}

/// A dense matrix of few rows, stored by columns padded to chunks.
struct DenseMatrix {
  const double* values;
  Index rows, columns;
  Index stride() const { return chunks_for(rows) * kChunk; }
};

struct Dense {
  /// y := A x
  void (*multiply)(const DenseMatrix&, const double* x, double* y);
  /// y := the sum of these columns times their entries of x
  void (*multiply_chosen)(const DenseMatrix&, const Index* columns, Index count, const double* x, double* y);
  /// y0 := A x0, y1 := A x1
  void (*multiply_two)(const DenseMatrix&, const double* x0, const double* x1, double* y0, double* y1);
};

/// For the chosen instruction set.
const Dense& dense();

}  // namespace butee::linalg::kernel

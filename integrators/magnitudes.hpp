#pragma once

#include <cmath>

#include "butee/core/types.hpp"

namespace butee::integrators {

/// sums_i += factor sum_j |A_ij| |y_j|, the magnitudes of the terms of A y.
inline void add_magnitudes(const SparseMatrix& matrix, double factor, ConstVectorRef y, VectorRef sums) {
  if (factor == 0.0) return;
  for (Index j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      sums[entry.row()] += factor * std::abs(entry.value() * y[j]);
}

}  // namespace butee::integrators

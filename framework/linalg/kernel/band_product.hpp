#pragma once

#include <array>

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg::kernel {

/// A range of rows of a product, and the total number of rows.
struct Rows {
  Index begin, end, size;
};

/// A symmetric-pattern band matrix: its diagonals above[k][i] = A(i, i + k) and below[k][i] = A(i,
/// i - k), zero for missing entries. If `chunks` is not empty, it holds the same for each chunk of
/// rows contiguously, above 0 ... band followed by below 1 ... band, and the last two chunks again
/// as they end the matrix.
struct BandMatrix {
  const double *const *above, *const *below;
  const ChunkTable& chunks;
};

inline constexpr std::size_t kWidestProduct = 8;

/// y := rows of A x
using BandProduct = void (*)(const BandMatrix&, Rows, const double* x, double* y);

/// For every band up to kWidestProduct, for the chosen instruction set.
const std::array<BandProduct, kWidestProduct + 1>& band_products();

}  // namespace butee::linalg::kernel

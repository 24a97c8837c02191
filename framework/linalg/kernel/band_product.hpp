#pragma once

#include <array>

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg::kernel {

/// Rows of a product, and the size of all of it.
struct Rows {
  Index begin, end, size;
};

/// A symmetric band matrix: its diagonals, above[k][i] = A(i, i + k) and below[k][i] = A(i, i - k), zero where there is
/// no such entry; or, where `chunks` is not empty, for each chunk of rows the same in a row, above 0 ... band behind
/// below 1 ... band, and for the last two chunks again as they end the matrix.
struct BandMatrix {
  const double *const *above, *const *below;
  const ChunkTable& chunks;
};

inline constexpr std::size_t kWidestProduct = 8;

/// y := rows of A x
using BandProduct = void (*)(const BandMatrix&, Rows, const double* x, double* y);

/// For every band up to kWidestProduct, of the chosen instruction set.
const std::array<BandProduct, kWidestProduct + 1>& band_products();

}  // namespace butee::linalg::kernel

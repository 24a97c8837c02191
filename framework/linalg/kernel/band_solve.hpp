#pragma once

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg::kernel {

/// Rows per chunk of a factor.
inline constexpr Index kFactorRows = 8;

/// The data of BandFactor: pairs (from the top, from the bottom) for every eliminated row.
struct FactorView {
  Index size, steps;
  const ChunkTable &forward, &backward;
  const double* middle_inverse;
};

/// The term subtracted from a solution: factor v.
struct Subtrahend {
  double factor;
  const double* v;
};

/// x := A^-1 x - less
using BandSolve = void (*)(const FactorView&, double* x, const Subtrahend& less);

inline constexpr Index kWidestFactor = 8;

/// For bands 1 to kWidestFactor; `subtracts` is true if a term is subtracted.
BandSolve band_solve(Index band, bool subtracts);

}  // namespace butee::linalg::kernel

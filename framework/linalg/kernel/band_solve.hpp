#pragma once

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg::kernel {

/// Steps of a chunk of a factor.
inline constexpr Index kFactorRows = 8;

/// What BandFactor holds: pairs (from the top, from the bottom) for every row eliminated.
struct FactorView {
  Index size, steps;
  const ChunkTable &forward, &backward;
  const double* middle_inverse;
};

/// What is taken from a solution: factor v.
struct Subtrahend {
  double factor;
  const double* v;
};

/// x := A^-1 x - less
using BandSolve = void (*)(const FactorView&, double* x, const Subtrahend& less);

inline constexpr Index kWidestFactor = 8;

/// For bands 1 to kWidestFactor; `subtracts` where there is something to take away.
BandSolve band_solve(Index band, bool subtracts);

}  // namespace butee::linalg::kernel

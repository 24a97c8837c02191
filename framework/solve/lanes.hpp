#pragma once

#include <cstring>

#include "butee/core/types.hpp"

/// Private to the kernels of this folder.
namespace butee::solve {

/// Eight doubles, which the compiler maps to the registers there are. Passed by reference, since how a function
/// takes such a value depends on the instruction set.
using Lane = double __attribute__((vector_size(64)));
inline constexpr Index kLaneSize = 8;

inline void load(const double* from, Lane& to) {
  std::memcpy(&to, from, sizeof(Lane));
}
inline void store(const Lane& from, double* to) {
  std::memcpy(to, &from, sizeof(Lane));
}
inline double sum(const Lane& lane) {
  return ((lane[0] + lane[4]) + (lane[1] + lane[5])) + ((lane[2] + lane[6]) + (lane[3] + lane[7]));
}

/// Whole lanes that hold `size` doubles.
constexpr Index lanes_for(Index size) {
  return (size + kLaneSize - 1) / kLaneSize;
}

}  // namespace butee::solve

#pragma once

#include <algorithm>

#include "butee/core/types.hpp"

namespace butee {

/// The number of rows of about ten vectors that stay in a core's cache while several operations
/// pass over them; a multiple of the size of any register.
inline constexpr Index kBlock = 2048;
/// With fewer than two blocks all rows form one block.
inline constexpr Index kLargestBlock = 2 * kBlock - 1;

/// Calls work(begin, count) for one block of rows after the other, so that data shared by several
/// operations are read from memory once. Memory access limits the speed of systems with a million
/// DOFs.
template <class Work>
void in_blocks(Index size, const Work& work) {
  Index begin = 0;
  for (; size - begin > kLargestBlock; begin += kBlock) work(begin, kBlock);
  work(begin, size - begin);
}

/// The number of blocks, and the block of a row.
constexpr std::size_t block_count(Index size) {
  return size > kLargestBlock ? static_cast<std::size_t>(size / kBlock) : 1;
}
constexpr std::size_t block_of(Index row, Index size) {
  return std::min(static_cast<std::size_t>(row / kBlock), block_count(size) - 1);
}

/// Calls row(i) for every row. No row may read what another writes, so that several are computed at
/// once. With one DOF it costs a few instructions; an expression of vectors would cost tens.
template <class Row>
void for_rows(Index size, const Row& row) {
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#elif defined(__GNUC__)
#pragma GCC ivdep
#endif
  for (Index i = 0; i < size; ++i) row(i);
}

}  // namespace butee

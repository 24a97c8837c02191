#pragma once

#include <algorithm>

#include "butee/core/types.hpp"

namespace butee {

/// Rows, of some ten vectors, that a core keeps in its cache while several operations go over them; a multiple of any
/// register's size.
inline constexpr Index kBlock = 2048;
/// Below two blocks there is one for all rows.
inline constexpr Index kLargestBlock = 2 * kBlock - 1;

/// Calls work(begin, count) for one block of rows after the other, so that what several operations share is read from
/// memory once: systems of a million DOFs are bound by that.
template <class Work>
void in_blocks(Index size, const Work& work) {
  Index begin = 0;
  for (; size - begin > kLargestBlock; begin += kBlock) work(begin, kBlock);
  work(begin, size - begin);
}

/// The blocks that there are, and the one that a row belongs to.
constexpr std::size_t block_count(Index size) {
  return size > kLargestBlock ? static_cast<std::size_t>(size / kBlock) : 1;
}
constexpr std::size_t block_of(Index row, Index size) {
  return std::min(static_cast<std::size_t>(row / kBlock), block_count(size) - 1);
}

/// Calls row(i) for every row. What one writes no other may read, so that several are taken at once; of one DOF it
/// costs a few instructions, where an expression of vectors costs tens.
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

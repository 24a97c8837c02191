#pragma once

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

}  // namespace butee

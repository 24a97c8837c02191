#pragma once

#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::linalg {

/// Chunks of doubles, equal ones stored once where that saves most of them: the rows of a uniform beam repeat, and
/// those of its factor from a hundred rows behind its end, to the last digit. Systems of a million DOFs, which are
/// bound by what a step reads from memory, then read little but their state.
class BUTEE_EXPORT ChunkTable {
 public:
  ChunkTable() = default;
  /// `count` chunks of `width` doubles, zero.
  ChunkTable(Index width, Index count);

  /// All chunks in a row, to be written; what they held is lost where some were shared.
  double* write();
  /// Stores equal chunks once, if there are so many.
  void share();

  const double* operator[](Index chunk) const { return data_.data() + place_[static_cast<std::size_t>(chunk)]; }
  bool empty() const { return place_.empty(); }
  bool is_shared() const { return data_.size() < width_ * static_cast<Index>(place_.size()); }

 private:
  void place_apart();

  Index width_ = 0;
  Vector data_;
  std::vector<Index> place_;  ///< in data_
};

}  // namespace butee::linalg

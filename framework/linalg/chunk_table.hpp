#pragma once

#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::linalg {

/// Chunks of doubles; equal chunks are stored once if that saves most of them. The rows of a
/// uniform beam repeat, and those of its factor do to the last digit from a hundred rows behind its
/// ends. Systems of a million DOFs, whose speed is limited by the memory read in a step, then read
/// little more than their state.
class BUTEE_EXPORT ChunkTable {
 public:
  ChunkTable() = default;
  /// `count` chunks of `width` doubles, zero.
  ChunkTable(Index width, Index count);

  /// All chunks contiguously, for writing; the contents are lost if some were shared.
  double* write();
  /// Stores equal chunks once, if there are enough of them.
  void share();

  const double* operator[](Index chunk) const { return data_.data() + place_[static_cast<std::size_t>(chunk)]; }
  bool empty() const { return place_.empty(); }
  bool is_shared() const { return data_.size() < width_ * static_cast<Index>(place_.size()); }

 private:
  void place_apart();

  Index width_ = 0;
  Vector data_;
  std::vector<Index> place_;  ///< offsets in data_
};

}  // namespace butee::linalg

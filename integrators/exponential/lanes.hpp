#pragma once

#include <Eigen/Core>

#include "butee/core/types.hpp"

namespace butee::integrators {

/// Columns of numbers, for example one for each node of a step. Each row is contiguous and fills one or two registers.
template <int kCount>
using LanesOf = Eigen::Matrix<double, Eigen::Dynamic, kCount, Eigen::RowMajor>;
using Lanes = LanesOf<8>;
/// A row of Lanes.
template <int kCount>
using LaneOf = Eigen::Array<double, kCount, 1>;
using Lane = LaneOf<8>;

template <int kCount>
Eigen::Map<const LaneOf<kCount>> lane_of(const LanesOf<kCount>& all, Index row) {
  return Eigen::Map<const LaneOf<kCount>>(all.data() + kCount * row);
}
template <int kCount>
Eigen::Map<LaneOf<kCount>> lane_of(LanesOf<kCount>& all, Index row) {
  return Eigen::Map<LaneOf<kCount>>(all.data() + kCount * row);
}

}  // namespace butee::integrators

#pragma once

#include "butee/core/types.hpp"

namespace butee::linalg {

/// Matrices in extended precision: sparse, and dense with few columns.
using ExtendedMatrix = Eigen::SparseMatrix<long double>;
using ExtendedColumns = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace butee::linalg

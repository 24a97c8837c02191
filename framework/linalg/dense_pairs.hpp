#pragma once

#include <optional>

#include <butee/export.hpp>

#include "butee/linalg/extended.hpp"

namespace butee::linalg {

/// Systems up to this size are solved densely, which is as fast as any other method and always
/// converges.
inline constexpr Index kDense = 200;

/// Eigenvalues, ascending, and their vectors, one in each column.
struct Pairs {
  Vector values;
  Eigen::MatrixXd vectors;
};

/// All pairs of K x = lambda M x with X^T M X = 1, for dense symmetric matrices, M positive
/// definite; nothing if the iteration did not converge. For this project, not installed: Eigen's
/// solvers are compiled once, here.
BUTEE_EXPORT std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

/// The same for sparse matrices, computed densely; faster if M is nearly diagonal. Each vector is
/// nonzero in only one connected part of the matrices, such as one of two planes.
BUTEE_EXPORT std::optional<Pairs> dense_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass);

/// The eigenvalues alone.
BUTEE_EXPORT std::optional<Vector> dense_values(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass);

/// All pairs of a dense symmetric matrix.
BUTEE_EXPORT std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& matrix);

/// All pairs of K x = lambda M x in extended precision.
struct ExtendedPairs {
  ExtendedColumns values, vectors;  ///< n x 1 and n x n
};
BUTEE_EXPORT std::optional<ExtendedPairs> extended_pairs(const ExtendedColumns& stiffness, const ExtendedColumns& mass);

}  // namespace butee::linalg

#pragma once

#include <complex>
#include <optional>

#include <butee/export.hpp>

#include "butee/linalg/extended.hpp"

namespace butee::linalg {

/// Eigenvalues in no order, and their vectors of length 1, one in each column.
struct ComplexPairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// All pairs of any square matrix, complex ones exactly conjugate; nothing if the iterations do not converge or an
/// entry is not finite. Not installed.
BUTEE_EXPORT std::optional<ComplexPairs> general_pairs(const Eigen::MatrixXd& matrix);

/// All pairs in extended precision, by the real iteration, with the inverse of the vectors.
struct ExtendedComplexPairs {
  Eigen::Matrix<std::complex<long double>, Eigen::Dynamic, 1> values;
  Eigen::Matrix<std::complex<long double>, Eigen::Dynamic, Eigen::Dynamic> vectors, inverse;
};
BUTEE_EXPORT std::optional<ExtendedComplexPairs> general_pairs(const ExtendedColumns& matrix);

/// The eigenvalues of any square matrix.
BUTEE_EXPORT std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace butee::linalg

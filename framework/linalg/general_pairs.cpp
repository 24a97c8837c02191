#include "butee/linalg/general_pairs.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace butee::linalg {

std::optional<ComplexPairs> general_pairs(const Eigen::MatrixXd& matrix, Fallback fallback) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() == Eigen::Success) return ComplexPairs{solver.eigenvalues(), solver.eigenvectors()};
  if (fallback == Fallback::none) return std::nullopt;
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> complex(matrix.cast<std::complex<double>>());
  if (complex.info() != Eigen::Success) return std::nullopt;
  return ComplexPairs{complex.eigenvalues(), complex.eigenvectors()};
}

std::optional<ExtendedComplexPairs> general_pairs(const ExtendedColumns& matrix) {
  const Eigen::EigenSolver<ExtendedColumns> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  ExtendedComplexPairs pairs{solver.eigenvalues(), solver.eigenvectors(), {}};
  pairs.inverse = pairs.vectors.partialPivLu().inverse();
  return pairs;
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

}  // namespace butee::linalg

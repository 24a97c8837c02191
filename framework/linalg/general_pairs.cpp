#include "butee/linalg/general_pairs.hpp"

#include <Eigen/Eigenvalues>

namespace butee::linalg {

std::optional<ComplexPairs> general_pairs(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() == Eigen::Success) return ComplexPairs{solver.eigenvalues(), solver.eigenvectors()};
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> complex(matrix.cast<std::complex<double>>());
  if (complex.info() != Eigen::Success) return std::nullopt;
  return ComplexPairs{complex.eigenvalues(), complex.eigenvectors()};
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

}  // namespace butee::linalg

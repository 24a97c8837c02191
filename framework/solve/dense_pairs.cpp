#include "butee/solve/dense_pairs.hpp"

#include <Eigen/Eigenvalues>

namespace butee::solve {

std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Pairs{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Vector> dense_values(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Pairs{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

ExtendedColumns extended_vectors(const ExtendedColumns& stiffness, const ExtendedColumns& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<ExtendedColumns> solver(stiffness, mass);
  if (solver.info() != Eigen::Success) return {};
  return solver.eigenvectors();
}

}  // namespace butee::solve

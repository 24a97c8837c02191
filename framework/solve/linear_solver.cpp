#include "butee/solve/linear_solver.hpp"

#include <Eigen/Cholesky>

namespace butee::solve {

LinearSolver::LinearSolver(const SparseMatrix& matrix, Counters& counters) : counters_(&counters) {
  if (matrix.rows() > kLargestInverse) factor_.emplace(matrix, counters);
}

bool LinearSolver::factorize(const SparseMatrix& matrix) {
  if (factor_) return factor_->factorize(matrix);
  ++counters_->factorizations;
  const Eigen::LLT<Eigen::MatrixXd> cholesky{Eigen::MatrixXd(matrix)};
  if (cholesky.info() != Eigen::Success) return false;
  inverse_ = cholesky.solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  right_.resize(matrix.rows());
  product_ = DenseProduct(inverse_);
  return inverse_.allFinite();
}

void LinearSolver::solve(VectorRef b) {
  if (factor_) return factor_->solve(b);
  ++counters_->solves;
  if (b.size() == 1) {
    b[0] *= inverse_(0, 0);
    return;
  }
  right_ = b;
  product_.multiply(right_.data(), b.data());
}

}  // namespace butee::solve

#include "butee/solve/linear_solver.hpp"

#include <Eigen/Cholesky>

#include "butee/solve/symmetric_product.hpp"

namespace butee::solve {

LinearSolver::LinearSolver(const SparseMatrix& matrix, Counters& counters) : counters_(&counters) {
  const Index size = matrix.rows(), band = bandwidth(matrix);
  if (size <= kTiny) return;
  if (BandFactor::fits(size, band))
    band_.emplace(size, band);
  else if (size > kLargestInverse)
    factor_.emplace(matrix, counters);
}

bool LinearSolver::factorize(const SparseMatrix& matrix) {
  if (factor_) return factor_->factorize(matrix);
  ++counters_->factorizations;
  if (band_) return band_->factorize(matrix);
  const Eigen::LLT<Eigen::MatrixXd> cholesky{Eigen::MatrixXd(matrix)};
  if (cholesky.info() != Eigen::Success) return false;
  const Eigen::MatrixXd inverse = cholesky.solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  reciprocal_ = inverse(0, 0);
  right_.resize(matrix.rows());
  inverse_ = DenseProduct(inverse);
  return inverse.allFinite();
}

void LinearSolver::solve(VectorRef b) {
  if (factor_) return factor_->solve(b);
  ++counters_->solves;
  if (b.size() == 1) {
    b[0] *= reciprocal_;
  } else if (band_) {
    band_->solve(b.data());
  } else {
    right_ = b;
    inverse_.multiply(right_.data(), b.data());
  }
}

}  // namespace butee::solve

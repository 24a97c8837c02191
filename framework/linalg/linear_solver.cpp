#include "butee/linalg/linear_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "butee/linalg/symmetric_product.hpp"

namespace butee::linalg {

LinearSolver::LinearSolver(const SparseMatrix& matrix, Counters& counters, const LowRank* term, bool is_symmetric)
    : counters_(&counters), term_(term), is_symmetric_(is_symmetric) {
  const Index size = matrix.rows(), band = bandwidth(matrix);
  if (size <= kTiny) return;
  if (!is_symmetric) {
    general_.emplace(matrix, counters);
    return;
  }
  if (term != nullptr && term->prefers_dense()) {
    if (size > kLargestInverse) dense_ = std::make_unique<DenseFactor>();
    return;
  }
  if (BandFactor::fits(size, band))
    band_.emplace(size, band);
  else if (size > kLargestInverse)
    factor_.emplace(matrix, counters);
  if (term != nullptr && (band_ || factor_)) low_rank_ = std::make_unique<LowRankUpdate>(*term);
}

bool LinearSolver::factorize(const SparseMatrix& matrix, double c) {
  if (general_) return general_->factorize(matrix);
  if (!band_ && !factor_) return factorize_dense(matrix, c);
  if (!factorize_sparse(matrix)) return false;
  return !low_rank_ || low_rank_->set(c, [this](VectorRef b) { solve_sparse(b); });
}

bool LinearSolver::factorize_sparse(const SparseMatrix& matrix) {
  if (factor_) return factor_->factorize(matrix);
  ++counters_->factorizations;
  return band_->factorize(matrix);
}

bool LinearSolver::factorize_dense(const SparseMatrix& matrix, double c) {
  ++counters_->factorizations;
  Eigen::MatrixXd full(matrix);
  if (term_ != nullptr) term_->add_to(full, c);
  if (dense_) return dense_->factorize(full);
  const Eigen::MatrixXd unity = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  Eigen::MatrixXd inverse;
  if (is_symmetric_) {
    const Eigen::LLT<Eigen::MatrixXd> cholesky(full);
    if (cholesky.info() != Eigen::Success) return false;
    inverse = cholesky.solve(unity);
  } else {
    inverse = Eigen::PartialPivLU<Eigen::MatrixXd>(full).solve(unity);
  }
  reciprocal_ = inverse(0, 0);
  right_.resize(matrix.rows());
  inverse_ = DenseProduct(inverse);
  return inverse.allFinite();
}

void LinearSolver::solve(VectorRef b) {
  solve_sparse(b);
  if (low_rank_) low_rank_->correct(b);
}

void LinearSolver::solve_less(VectorRef b, double factor, ConstVectorRef v) {
  if (!band_ || low_rank_ || factor == 0.0) {
    solve(b);
    if (factor != 0.0) b -= factor * v;
    return;
  }
  ++counters_->solves;
  band_->solve_less(b.data(), factor, v.data());
}

void LinearSolver::solve_sparse(VectorRef b) {
  if (factor_) return factor_->solve(b);
  if (general_) return general_->solve(b);
  ++counters_->solves;
  if (b.size() == 1) {
    b[0] *= reciprocal_;
  } else if (band_) {
    band_->solve(b.data());
  } else if (dense_) {
    dense_->solve(b);
  } else {
    right_ = b;
    inverse_.multiply(right_.data(), b.data());
  }
}

}  // namespace butee::linalg

#include "butee/linalg/low_rank.hpp"

namespace butee::linalg {

void LowRank::add_to(Eigen::MatrixXd& matrix, double c) const {
  matrix.noalias() += c * factor_ * factor_.transpose();
}

bool LowRankUpdate::set(double c, const std::function<void(VectorRef)>& solve) {
  const Eigen::MatrixXd& factor = term_.factor();
  c_ = c;
  solved_ = factor;
  for (Index j = 0; j < solved_.cols(); ++j) solve(solved_.col(j));
  Eigen::MatrixXd small = c * factor.transpose() * solved_;
  small.diagonal().array() += 1.0;
  small_.compute(small);
  work_.resize(factor.cols());
  return small_.info() == Eigen::Success;
}

void LowRankUpdate::correct(VectorRef y) {
  work_.noalias() = term_.factor().transpose() * y;
  small_.solveInPlace(work_);
  y.noalias() -= c_ * (solved_ * work_);
}

bool DenseFactor::factorize(const Eigen::MatrixXd& matrix) {
  factor_.compute(matrix);
  return factor_.info() == Eigen::Success;
}

void DenseFactor::solve(VectorRef b) const {
  factor_.solveInPlace(b);
}

}  // namespace butee::linalg

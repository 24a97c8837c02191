#include "butee/dynamics/tangent_solver.hpp"

#include <cmath>

namespace butee::dynamics {

bool TangentSolver::set(double on_v, double on_x, ConstVectorRef kappa, std::span<const Obstacles::Tangent> tangents) {
  effective_.set_factors(on_v, on_x);
  kappa_ = kappa;
  contacts_.clear();
  blocks_.clear();
  for (const Obstacles::Tangent& tangent : tangents) {
    contacts_.push_back(tangent.contact);
    blocks_.push_back(on_v * tangent.damping + on_x * tangent.stiffness);
  }
  if (contacts_.empty()) return true;
  const auto count = static_cast<Index>(contacts_.size());
  const Index n = obstacles_->system_size();
  motion_.setZero(n, 2 * count);
  for (Index j = 0; j < count; ++j)
    for (Index k = 0; k < 2; ++k) {
      auto column = motion_.col(2 * j + k);
      obstacles_->scatter(contacts_[static_cast<std::size_t>(j)], Eigen::Vector2d::Unit(k), column);
      if (!column.isZero(0.0) && !effective_.solve(kappa_, column)) return false;
    }
  Eigen::MatrixXd small = Eigen::MatrixXd::Identity(2 * count, 2 * count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < 2 * count; ++j)
      small.block<2, 1>(2 * i, j) += blocks_[static_cast<std::size_t>(i)] *
                                     obstacles_->gather(contacts_[static_cast<std::size_t>(i)], motion_.col(j));
  small_.compute(small);
  right_.resize(2 * count);
  return std::isfinite(small.sum());
}

bool TangentSolver::solve(VectorRef b) {
  if (!effective_.solve(kappa_, b)) return false;
  if (contacts_.empty()) return true;
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    right_.segment<2>(2 * static_cast<Index>(i)) = blocks_[i] * obstacles_->gather(contacts_[i], b);
  right_ = small_.solve(right_).eval();
  b -= motion_ * right_;
  return true;
}

}  // namespace butee::dynamics

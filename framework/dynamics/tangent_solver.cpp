#include "butee/dynamics/tangent_solver.hpp"

#include <cmath>

namespace butee::dynamics {

bool has_infinite_slope(const Obstacles& obstacles) {
  for (Index i = 0; i < obstacles.size(); ++i) {
    const model::ObstacleGroup& group = obstacles.group_of(i);
    if (group.damping.kind == model::ImpactDamping::Kind::jankowski) return true;
    if (group.damping.kind != model::ImpactDamping::Kind::law) continue;
    // A slope proportional to g^-p grows by 10^(8 p) between these two penetrations.
    constexpr double kLittle = 1e-8, kLess = 1e-16, kGrows = 10.0;
    const auto slope = [&](double g) { return std::abs(group.law->rated_force(g, 1.0, false).by_penetration); };
    if (!(slope(kLess) <= kGrows * slope(kLittle))) return true;
  }
  return false;
}

bool TangentSolver::set(double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                        std::span<const Obstacles::Tangent> tangents) {
  effective_.set_factors(velocity_factor, displacement_factor);
  kappa_ = kappa;
  contacts_.clear();
  blocks_.clear();
  stiffness_.clear();
  for (const Obstacles::Tangent& tangent : tangents) {
    contacts_.push_back(tangent.contact);
    stiffness_.push_back(tangent.stiffness);
    blocks_.push_back(velocity_factor * tangent.damping + displacement_factor * tangent.stiffness);
  }
  is_whole_ = contacts_.size() > kMostLocal && !effective_.has_modal_damping();
  if (is_whole_) return factorize_whole(kappa);
  if (contacts_.empty()) return true;
  const auto count = static_cast<Index>(contacts_.size());
  width_ = 2;
  for (const Index contact : contacts_)
    if (obstacles_->twists(contact)) width_ = 3;
  motion_.setZero(obstacles_->system_size(), width_ * count);
  for (Index j = 0; j < count; ++j)
    for (Index k = 0; k < width_; ++k) {
      auto column = motion_.col(width_ * j + k);
      obstacles_->scatter(contacts_[static_cast<std::size_t>(j)], Obstacles::Coordinates::Unit(k), column);
      if (!column.isZero(0.0) && !effective_.solve(kappa_, column)) return false;
    }
  Eigen::MatrixXd small = Eigen::MatrixXd::Identity(width_ * count, width_ * count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < width_ * count; ++j) {
      const Obstacles::Coordinates force = along(i, motion_.col(j));
      for (Index k = 0; k < width_; ++k) small(width_ * i + k, j) += force[k];
    }
  small_.compute(small);
  right_.resize(width_ * count);
  return std::isfinite(small.sum());
}

bool TangentSolver::factorize_whole(ConstVectorRef kappa) {
  const SparseMatrix& matrix = effective_.matrix(kappa);
  if (!whole_solver_) {
    std::vector<Eigen::Triplet<double>> places;
    for (Index column = 0; column < matrix.outerSize(); ++column)
      for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
        places.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column), 0.0);
    for (Index i = 0; i < obstacles_->size(); ++i)
      obstacles_->visit(i, Obstacles::Block::Ones(), [&](Index row, Index column, double) {
        places.emplace_back(static_cast<int>(row), static_cast<int>(column), 0.0);
        places.emplace_back(static_cast<int>(column), static_cast<int>(row), 0.0);
      });
    whole_.resize(matrix.rows(), matrix.cols());
    whole_.setFromTriplets(places.begin(), places.end());
    whole_solver_.emplace(whole_, effective_.counters(), nullptr, false);
  }
  whole_.coeffs().setZero();
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      whole_.coeffRef(entry.row(), column) = entry.value();
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    obstacles_->visit(contacts_[i], blocks_[i],
                      [&](Index row, Index column, double value) { whole_.coeffRef(row, column) += value; });
  return whole_solver_->factorize(whole_);
}

bool TangentSolver::solve(VectorRef b) {
  if (is_whole_) {
    whole_solver_->solve(b);
    return true;
  }
  if (!effective_.solve(kappa_, b)) return false;
  if (contacts_.empty()) return true;
  for (Index i = 0; i < static_cast<Index>(contacts_.size()); ++i) {
    const Obstacles::Coordinates force = along(i, b);
    for (Index k = 0; k < width_; ++k) right_[width_ * i + k] = force[k];
  }
  right_ = small_.solve(right_).eval();
  b -= motion_ * right_;
  return true;
}

Obstacles::Coordinates TangentSolver::along(Index i, ConstVectorRef y) const {
  return blocks_[static_cast<std::size_t>(i)] * obstacles_->gather(contacts_[static_cast<std::size_t>(i)], y);
}

void TangentSolver::add_stiffness(const ElasticStops& stops, ConstVectorRef y, VectorRef work, VectorRef force) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    obstacles_->scatter(contacts_[i], stiffness_[i] * obstacles_->gather(contacts_[i], y), force);
  if (stops.size() == 0) return;
  stops.displacement(y, work);
  work.array() *= kappa_.array();
  stops.scatter(work, force);
}

}  // namespace butee::dynamics

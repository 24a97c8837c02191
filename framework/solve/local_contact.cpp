#include "butee/solve/local_contact.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace butee::solve {
namespace {

/// A stop is near where its stiffness changes its own displacement by more than this.
constexpr double kNear = 1e-3;
/// Sweeps contract by about kNear or better; this many mean that they do not.
constexpr int kMostSweeps = 40;
/// Sweeps end where one more would change the forces by less than a few rounding errors of the largest: those of near
/// stops follow the last change of the far ones, and without near stops the next change is smaller by the contraction.
constexpr double kRounding = 1e-15;

}  // namespace

LocalContact::LocalContact(const Contact& contact)
    : contact_(contact), compliance_(contact.size(), contact.size()), near_matrix_(compliance_) {
  free_ = force_ = far_force_ = sum_ = near_ = Vector::Zero(contact.size());
  near_stops_.reserve(static_cast<std::size_t>(contact.size()));
}

void LocalContact::set_base(LinearSolver& base) {
  const Index m = contact_.size(), n = contact_.system_size();
  const bool dense = base.inverse().size() > 0;
  Eigen::MatrixXd influence(dense ? n : 0, dense ? m : 0);
  Vector unit = Vector::Zero(m), column;
  for (Index j = 0; j < m; ++j) {
    column.setZero(n);
    unit[j] = 1.0;
    contact_.scatter(unit, column);
    unit[j] = 0.0;
    if (dense) {
      influence.col(j).noalias() = base.inverse() * column;
      column = influence.col(j);
    } else {
      base.solve(column);
    }
    contact_.displacement(column, sum_);
    compliance_.col(j) = sum_;
  }
  if (dense) influence_ = DenseProduct(influence);
  if (m <= DenseProduct::kMostRows) fast_compliance_ = DenseProduct(compliance_);
  row_sum_ = compliance_.cwiseAbs().rowwise().sum().maxCoeff();
  work_.resize(n);
}

void LocalContact::multiply_compliance(const Vector& force, Vector& displacement) const {
  if (fast_compliance_.empty())
    displacement.noalias() = compliance_ * force;
  else
    fast_compliance_.multiply(force.data(), displacement.data());
}

bool LocalContact::correct(LinearSolver& base, double stiffness_factor, ConstVectorRef kappa, VectorRef y) {
  contact_.displacement(y, free_);
  if (!find_forces(stiffness_factor, kappa)) return false;
  if (!near_stops_.empty() || far_acts_) apply(base, stiffness_factor, y);
  return true;
}

void LocalContact::divide(double k, ConstVectorRef kappa) {
  near_stops_.clear();
  far_acts_ = false;
  for (Index i = 0; i < kappa.size(); ++i) {
    if (k * kappa[i] * compliance_(i, i) > kNear)
      near_stops_.push_back(i);
    else if (kappa[i] != 0.0)
      far_acts_ = true;
  }
}

bool LocalContact::factorize_near(double k, ConstVectorRef kappa) {
  const auto size = static_cast<Index>(near_stops_.size());
  for (Index j = 0; j < size; ++j) {
    const Index stop = near_stops_[static_cast<std::size_t>(j)];
    for (Index i = 0; i < size; ++i) near_matrix_(i, j) = compliance_(near_stops_[static_cast<std::size_t>(i)], stop);
    near_matrix_(j, j) += 1.0 / (k * kappa[stop]);
  }
  if (size == 1) return near_matrix_(0, 0) > 0.0;
  Eigen::Ref<Eigen::MatrixXd> corner = near_matrix_.topLeftCorner(size, size);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(corner);
  return cholesky.info() == Eigen::Success;
}

bool LocalContact::find_forces(double k, ConstVectorRef kappa) {
  divide(k, kappa);
  const auto size = static_cast<Index>(near_stops_.size());
  if (size > 0 && !factorize_near(k, kappa)) return false;
  const auto solve_near = [&] {
    for (Index i = 0; i < size; ++i) {
      const Index stop = near_stops_[static_cast<std::size_t>(i)];
      near_[i] = free_[stop] / k - sum_[stop];
    }
    auto right = near_.head(size);
    if (size == 1) {
      right[0] /= near_matrix_(0, 0);
    } else {
      const auto factor = near_matrix_.topLeftCorner(size, size);
      factor.triangularView<Eigen::Lower>().solveInPlace(right);
      factor.triangularView<Eigen::Lower>().transpose().solveInPlace(right);
    }
  };
  if (!far_acts_) {
    sum_.setZero();
    force_.setZero();
    if (size > 0) solve_near();
    for (Index i = 0; i < size; ++i) force_[near_stops_[static_cast<std::size_t>(i)]] = near_[i];
    return true;
  }
  far_force_ = kappa;
  for (const Index stop : near_stops_) far_force_[stop] = 0.0;
  const double contraction = k * far_force_.maxCoeff() * row_sum_;
  far_force_.array() *= free_.array();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    multiply_compliance(far_force_, sum_);
    if (size > 0) solve_near();
    for (Index i = 0; i < size; ++i) sum_ += near_[i] * compliance_.col(near_stops_[static_cast<std::size_t>(i)]);
    force_ = kappa.cwiseProduct(free_ - k * sum_);
    for (const Index stop : near_stops_) force_[stop] = 0.0;
    const double change = (force_ - far_force_).lpNorm<Eigen::Infinity>();
    const double largest =
        std::max(force_.lpNorm<Eigen::Infinity>(), size > 0 ? near_.head(size).lpNorm<Eigen::Infinity>() : 0.0);
    far_force_ = force_;
    if ((size > 0 ? change : contraction * change) <= kRounding * largest) {
      for (Index i = 0; i < size; ++i) force_[near_stops_[static_cast<std::size_t>(i)]] = near_[i];
      return true;
    }
  }
  return false;
}

void LocalContact::apply(LinearSolver& base, double k, VectorRef y) {
  if (!influence_.empty()) {
    influence_.multiply(force_.data(), work_.data());
  } else {
    work_.setZero();
    contact_.scatter(force_, work_);
    base.solve(work_);
  }
  y -= k * work_;
}

}  // namespace butee::solve

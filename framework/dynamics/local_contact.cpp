#include "butee/dynamics/local_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

namespace butee::dynamics {
namespace {

/// A stop is near if its stiffness changes displacements by more than this.
constexpr double kNear = 1e-3;
/// Stops whose stiffness changes the solution by less than this are omitted. The effect equals that
/// of an equal relative error in the masses; the change of the displacements at the end of a step,
/// k times the solution, is far below their rounding.
constexpr double kHidden = 1e-11;
/// Sweeps continue until their changes are lost in rounding.
constexpr double kLostInRounding = 1e-17;

}  // namespace

LocalContact::LocalContact(const ElasticStops& contact)
    : contact_(contact), compliance_(contact.size(), contact.size()), near_matrix_(compliance_) {
  contraction_bound_ = free_ = force_ = sum_ = near_ = Vector::Zero(contact.size());
  near_places_.resize(static_cast<std::size_t>(contact.size()));
  far_places_ = all_places_ = near_places_;
  std::iota(all_places_.begin(), all_places_.end(), 0);
}

void LocalContact::set_base(linalg::LinearSolver& base) {
  const Index m = contact_.size(), n = contact_.system_size();
  const bool small = n <= linalg::DenseProduct::kMostRows;
  Eigen::MatrixXd influence(small ? n : 0, small ? m : 0);
  Vector unit = Vector::Zero(m), column(n);
  for (Index j = 0; j < m; ++j) {
    column.setZero();
    unit[j] = 1.0;
    contact_.scatter(unit, column);
    unit[j] = 0.0;
    base.solve(column);
    if (small) influence.col(j) = column;
    contact_.displacement(column, sum_);
    compliance_.col(j) = sum_;
  }
  if (small) influence_ = linalg::DenseProduct(influence);
  if (m <= linalg::DenseProduct::kMostRows) fast_compliance_ = linalg::DenseProduct(compliance_);
  row_sums_ = compliance_.cwiseAbs().rowwise().sum();
  work_.resize(n);
}

bool LocalContact::correct(linalg::LinearSolver& base, double stiffness_factor, ConstVectorRef kappa, VectorRef y) {
  contact_.displacement(y, free_);
  divide(stiffness_factor, kappa);
  if (near_stops_.empty() && far_stops_.empty()) return true;
  if (!find_forces(stiffness_factor, kappa)) return false;
  apply(base, stiffness_factor, y);
  return true;
}

void LocalContact::divide(double k, ConstVectorRef kappa) {
  contraction_bound_ = k * kappa.cwiseProduct(row_sums_);
  near_stops_ = far_stops_ = {};
  contraction_ = 0.0;
  const double largest = contraction_bound_.maxCoeff();
  if (largest <= kHidden) return;
  if (largest <= kNear && contraction_bound_.minCoeff() > kHidden) {
    far_stops_ = all_places_;
    contraction_ = largest;
    return;
  }
  std::size_t near = 0, far = 0;
  for (Index i = 0; i < contraction_bound_.size(); ++i) {
    if (contraction_bound_[i] > kNear)
      near_places_[near++] = i;
    else if (contraction_bound_[i] > kHidden)
      far_places_[far++] = i;
  }
  near_stops_ = std::span(near_places_).first(near);
  far_stops_ = std::span(far_places_).first(far);
  for (const Index stop : far_stops_) contraction_ = std::max(contraction_, contraction_bound_[stop]);
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
  if (!near_stops_.empty() && !factorize_near(k, kappa)) return false;
  far_is_spread_ = false;
  sum_.setZero();
  force_.setZero();
  solve_near(k);
  if (far_stops_.empty()) return true;
  update_far(k, kappa);
  // The error of a far force affects displacements by its relative error times the contraction; a
  // near force, which reacts to the far ones, is affected by the error itself.
  double error = near_stops_.empty() ? contraction_ * contraction_ : contraction_;
  for (; error > kLostInRounding; error *= contraction_) {
    spread_far();
    solve_near(k);
    update_far(k, kappa);
  }
  return true;
}

void LocalContact::spread_far() {
  if (!influence_.empty()) {
    influence_.multiply(far_stops_, force_.data(), work_.data());
    contact_.displacement(work_, sum_);
    far_is_spread_ = true;
  } else if (!fast_compliance_.empty()) {
    fast_compliance_.multiply(far_stops_, force_.data(), sum_.data());
  } else {
    sum_.setZero();
    for (const Index stop : far_stops_) sum_ += force_[stop] * compliance_.col(stop);
  }
}

void LocalContact::solve_near(double k) {
  const auto size = static_cast<Index>(near_stops_.size());
  for (Index i = 0; i < size; ++i) {
    const Index stop = near_stops_[static_cast<std::size_t>(i)];
    near_[i] = free_[stop] / k - sum_[stop];
  }
  if (size == 1) {
    near_[0] /= near_matrix_(0, 0);
  } else if (size > 1) {
    auto right = near_.head(size);
    const auto factor = near_matrix_.topLeftCorner(size, size);
    factor.triangularView<Eigen::Lower>().solveInPlace(right);
    factor.triangularView<Eigen::Lower>().transpose().solveInPlace(right);
  }
}

void LocalContact::update_far(double k, ConstVectorRef kappa) {
  for (std::size_t i = 0; i < near_stops_.size(); ++i)
    sum_ += near_[static_cast<Index>(i)] * compliance_.col(near_stops_[i]);
  if (2 * static_cast<Index>(far_stops_.size()) <= kappa.size()) {
    for (const Index stop : far_stops_) force_[stop] = kappa[stop] * (free_[stop] - k * sum_[stop]);
    return;
  }
  // Computing all at once is faster; the forces of the omitted stops are lost in rounding.
  force_ = kappa.cwiseProduct(free_ - k * sum_);
  for (const Index stop : near_stops_) force_[stop] = 0.0;
}

void LocalContact::apply(linalg::LinearSolver& base, double k, VectorRef y) {
  if (!influence_.empty() && !far_stops_.empty()) {
    if (!far_is_spread_) influence_.multiply(far_stops_, force_.data(), work_.data());
    y -= k * work_;
    if (near_stops_.empty()) return;
    force_.setZero();
  }
  for (std::size_t i = 0; i < near_stops_.size(); ++i) force_[near_stops_[i]] = near_[static_cast<Index>(i)];
  if (!influence_.empty()) {
    influence_.multiply(near_stops_, force_.data(), work_.data());
  } else {
    work_.setZero();
    contact_.scatter(force_, work_);
    base.solve(work_);
  }
  y -= k * work_;
}

}  // namespace butee::dynamics

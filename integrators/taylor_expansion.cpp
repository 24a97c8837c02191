#include "integrators/taylor_expansion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

/// The iteration for the reach ends if its ratio to the last value exceeds kSettled, or after
/// kMostTrials.
constexpr double kSettled = 0.98;
constexpr int kMostTrials = 40;

}  // namespace

double TaylorExpansion::value(Index dof, double s) const {
  double sum = 0.0;
  for (Index k = x.cols() - 1; k >= 0; --k) sum = sum * s + x(dof, k);
  return sum;
}

double TaylorExpansion::velocity(Index dof, double s) const {
  double sum = 0.0;
  for (Index k = x.cols() - 1; k >= 1; --k) sum = sum * s + static_cast<double>(k) * x(dof, k);
  return sum / length;
}

double TaylorExpansion::acceleration(Index dof, double s) const {
  double sum = 0.0;
  for (Index k = x.cols() - 1; k >= 2; --k) sum = sum * s + static_cast<double>(k * (k - 1)) * x(dof, k);
  return sum / (length * length);
}

TaylorExpander::TaylorExpander(dynamics::Dynamics& dynamics, int order, double tolerance)
    : dynamics_(dynamics),
      order_(order),
      tolerance_(tolerance),
      loads_(static_cast<Index>(dynamics.system().loads.size()), order + 1),
      load_(static_cast<std::size_t>(order) + 1),
      w_(dynamics.stop_count(), order + 1),
      force_(dynamics.size()),
      stop_force_(dynamics.stop_count()),
      stops_(dynamics.stop_count()),
      velocity_(dynamics.size()),
      terms_(order + 1),
      held_(Vector::Zero(order + 1)) {
  if (dynamics.obstacles() != nullptr) obstacles_.emplace(dynamics, order);
  for (const model::FreeLoad& load : dynamics.system().loads)
    if (!load.in_time->taylor(0.0, 1.0, load_))
      throw InputError("integrator.type: exact needs loads that give their Taylor series, as the standard ones do");
}

bool TaylorExpander::expand(double t, const Vector& x, const Vector& v, ContactBranches& branches,
                            TaylorExpansion& to) {
  to.begin = t;
  dynamics_.set_time(t);
  to.x.resize(x.size(), order_ + 1);
  to.x.col(0) = x;
  to.x.col(1) = to.length * v;
  expand_loads(t, to.length);
  recur(branches, to);
  if (branches.any_undecided()) {
    branches.decide(w_);
    recur(branches, to);
  }
  to.reach = find_reach(to.x);
  return to.reach > 0.0;
}

void TaylorExpander::expand_loads(double t, double length) {
  for (Index j = 0; j < loads_.rows(); ++j) {
    dynamics_.system().loads[static_cast<std::size_t>(j)].in_time->taylor(t, length, load_);
    for (Index k = 0; k <= order_; ++k) loads_(j, k) = load_[static_cast<std::size_t>(k)];
  }
}

void TaylorExpander::recur(ContactBranches& branches, TaylorExpansion& to) {
  dynamics::ElasticStops& contact = dynamics_.stops();
  const double h = to.length;
  if (obstacles_) obstacles_->begin(to.begin, to.x.col(0), to.x.col(1) / h, h);
  for (Index k = 0; k <= order_; ++k) {
    if (contact.size() > 0) {
      contact.displacement(to.x.col(k), stops_);
      w_.col(k) = stops_;
    }
    if (k + 2 > order_) continue;
    force_.setZero();
    for (Index j = 0; j < loads_.rows(); ++j) {
      const model::FreeLoad& load = dynamics_.system().loads[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < load.dofs.size(); ++i) force_[load.dofs[i]] += load.weights[i] * loads_(j, k);
    }
    if (contact.size() > 0) {
      branches.force(w_, k, stop_force_);
      contact.scatter(stop_force_, force_);
    }
    if (k > 0 && dynamics_.system().rotation != nullptr) {
      // If the speed of rotation is linear in time, C(t) and K(t) add C' h v_(k-1) + K' h x_(k-1).
      velocity_ = static_cast<double>(k) * to.x.col(k);
      dynamics_.subtract_matrix_rate(h * to.x.col(k - 1), velocity_, force_);
    }
    velocity_ = (static_cast<double>(k + 1) / h) * to.x.col(k + 1);
    if (obstacles_) obstacles_->add(k, to.x.col(k), velocity_, force_);
    dynamics_.solve_acceleration(to.x.col(k), velocity_, force_);
    if (obstacles_ && dynamics_.obstacles()->has_rigid_friction())
      held_[k + 2] = h * h / static_cast<double>(k + 1) * force_.lpNorm<Eigen::Infinity>();
    if (obstacles_) dynamics_.hold_sticks(k == 0 ? std::optional(to.begin) : std::nullopt, force_);
    to.x.col(k + 2) = (h * h / static_cast<double>((k + 1) * (k + 2))) * force_;
  }
}

double TaylorExpander::find_reach(const Eigen::MatrixXd& x) {
  // Terms of the velocity: in a short step they are small compared with the displacement, but
  // equally important.
  for (Index k = 0; k <= order_; ++k) terms_[k] = static_cast<double>(k) * x.col(k).lpNorm<Eigen::Infinity>();
  if (!terms_.allFinite() || !x.col(0).allFinite()) return 0.0;
  // If all bodies stick, the terms are rounding of the forces that hold them, whose own series has to end as well.
  terms_ = terms_.cwiseMax(held_);
  // The last terms are compared with the largest term within the reach; therefore the reach is
  // iterated from above.
  double reach = 1.0;
  for (int i = 0; i < kMostTrials; ++i) {
    double largest = 0.0, power = 1.0;
    for (Index k = 0; k <= order_; ++k, power *= reach) largest = std::max(largest, terms_[k] * power);
    double next = std::numeric_limits<double>::max();
    for (Index k = order_ - 1; k <= order_; ++k)
      if (terms_[k] > 0.0)
        next = std::min(next, std::pow(tolerance_ * largest / terms_[k], 1.0 / static_cast<double>(k)));
    if (next >= kSettled * reach) return i == 0 ? next : std::min(next, reach);
    reach = next;
  }
  return reach;
}

}  // namespace butee::integrators

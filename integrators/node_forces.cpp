#include "integrators/node_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

using time::State;

constexpr Index kCount = StepNodes::kCount, kEnd = StepNodes::kEnd;
constexpr int kMostSweeps = 25;
/// A sweep that changes the forces by more than this part of what the one before did will not come to an end soon.
constexpr double kContraction = 0.6;
/// Changes of a force below this part of it are rounding.
constexpr double kRounding = 1e-13;
/// The same of what contacts do to the end of a step, from which the polynomials' coefficients lose further digits.
constexpr double kRoundingOfEnd = 1e-12;

[[noreturn]] void refuse_law() {
  throw InputError(
      "integrator.type: the law of a contact is not piecewise linear; the form of exponential for coupled modes and "
      "contacts in the plane would not see where it bends; take rodas4, dopri5, extrapolation8 or exact, or auto, "
      "which "
      "chooses among them");
}

}  // namespace

NodeForces::NodeForces(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes)
    : dynamics_(dynamics), modes_(modes), mobility_(Vector::Zero(dynamics.size())) {
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const model::ObstacleGroup& group = obstacles->group_of(i);
      if (group.law != nullptr && !group.law->is_piecewise_linear()) refuse_law();
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take_contact(dof, obstacles->closed_stiffness(i));
      needs_velocity_ = needs_velocity_ || group.damping.kind != model::ImpactDamping::Kind::none ||
                        group.friction.rule != model::Friction::Rule::none;
    }
  const dynamics::Contact& contact = dynamics.contact();
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i) {
    if (!contact.law_of(i).is_piecewise_linear()) refuse_law();
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take_contact(dof, closed[i]);
  }
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  const Index p = modes.count();
  reach_ = Eigen::ArrayXd::Zero(p);
  for (const Index dof : dofs_) {
    const auto shape = modes.displacement().col(dof).array();
    reach_ = reach_.max((shape.head(p).square() + shape.tail(p).square()).sqrt());
  }
  x_ = v_ = force_ = Vector::Zero(dynamics.size());
  free_ = nodes_ = polynomial_ = missed_ = Eigen::MatrixXd::Zero(2 * p, kCount);
  error_ = Vector::Zero(2 * p);
}

void NodeForces::take_contact(Index dof, double stiffness) {
  if (dof < 0) return;
  dofs_.push_back(dof);
  // All modes together answer an impulse of 1 N s with it.
  mobility_[dof] = std::max(0.0, modes_.velocity().col(dof).dot(modes_.input().col(dof)));
  highest_frequency_ = std::max(highest_frequency_, std::sqrt(stiffness * mobility_[dof]));
}

double NodeForces::unresolved(const State& from, const double* z, double h) const {
  double scale = 0.0, sum = 0.0;
  const auto scales = LocalErrorControl::scales_x(from);
  for (const Index dof : dofs_) scale = std::max(scale, scales[dof]);
  if (scale == 0.0) return 0.0;
  const Index p = modes_.count();
  for (Index k = 0; k < p; ++k) {
    const double w = modes_.speed()[k] * h, square = w * w;
    sum += reach_[k] * std::hypot(z[k], z[p + k]) * std::min(2.0, StepNodes::kMiss * square * square * square * w);
  }
  return sum / scale;
}

void NodeForces::find_active() {
  std::vector<Index> active;
  const auto take = [&](Index dof) {
    if (dof >= 0) active.push_back(dof);
  };
  if (const dynamics::Obstacles* obstacles = dynamics_.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const bool is_apart = obstacles->group_of(i).shape != nullptr &&
                            obstacles->phase(i).normal == dynamics::ContactPhase::Normal::apart;
      if (is_apart) continue;
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take(dof);
    }
  const dynamics::Contact& contact = dynamics_.contact();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take(dof);
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  if (active == active_) return;
  active_ = std::move(active);
  const auto count = static_cast<Index>(active_.size());
  for (Eigen::MatrixXd* columns : {&input_, &displacement_, &velocity_}) columns->resize(2 * modes_.count(), count);
  for (AtNodes* rows : {&forces_, &moved_, &moved_velocity_}) rows->resize(count, kCount);
  for (Index k = 0; k < count; ++k) {
    const Index dof = active_[static_cast<std::size_t>(k)];
    input_.col(k) = modes_.input().col(dof);
    displacement_.col(k) = modes_.displacement().col(dof);
    velocity_.col(k) = modes_.velocity().col(dof);
  }
}

void NodeForces::find_forces(double t, double h, Index node) {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    x_[active_[k]] = moved_(static_cast<Index>(k), node);
    if (needs_velocity_) v_[active_[k]] = moved_velocity_(static_cast<Index>(k), node);
    force_[active_[k]] = 0.0;
  }
  dynamics_.add_contact_force(x_, force_);
  dynamics_.add_obstacle_force(t + StepNodes::kPlaces[static_cast<std::size_t>(node)] * h, x_, v_, force_);
  for (std::size_t k = 0; k < active_.size(); ++k) forces_(static_cast<Index>(k), node) = force_[active_[k]];
}

void NodeForces::find_forces(double t, double h) {
  moved_.rightCols(kCount - 1).noalias() = displacement_.transpose() * nodes_.rightCols(kCount - 1);
  if (needs_velocity_)
    moved_velocity_.rightCols(kCount - 1).noalias() = velocity_.transpose() * nodes_.rightCols(kCount - 1);
  for (Index j = 1; j < kCount; ++j) find_forces(t, h, j);
}

void NodeForces::move(const StepResponse& response, const StepNodes::Matrix& coefficients) {
  coefficients_.noalias() = forces_ * coefficients;
  polynomial_.noalias() = input_ * coefficients_;
  nodes_ = free_;
  response.add_force(polynomial_.data(), nodes_);
}

double NodeForces::change(const State& from, double h) const {
  const auto scale_x = LocalErrorControl::scales_x(from), scale_v = LocalErrorControl::scales_v(from);
  const double time = highest_frequency_ > 0.0 ? 1.0 / highest_frequency_ : h;
  double largest = 0.0;
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const auto now = forces_.row(static_cast<Index>(k)), before = forces_before_.row(static_cast<Index>(k));
    const double difference = (now - before).cwiseAbs().maxCoeff();
    if (std::isnan(difference)) return difference;
    if (difference <= kRounding * now.cwiseAbs().maxCoeff()) continue;
    // At a start from rest: the speed that the acceleration makes within 1/omega of the contact.
    const Index dof = active_[k];
    const double speed = std::max(scale_v[dof], time * std::abs(from.a[dof])),
                 way = std::max(scale_x[dof], time * speed), change = h * mobility_[dof] * difference;
    largest = std::max({largest, change / std::max(speed, change), h * change / std::max(way, h * change)});
  }
  return largest;
}

NodeForces::Outcome NodeForces::find(const State& from, const StepResponse& response, double settled) {
  find_active();
  error_.setZero();
  if (active_.empty()) {
    polynomial_.setZero();
    missed_.setZero();
    nodes_ = free_;
    return nodes_.allFinite() ? Outcome::converged : Outcome::not_finite;
  }
  start(from);
  const double t = from.t, h = response.h();
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostSweeps; ++round) {
    move(response, StepNodes::with_middle());
    forces_before_ = forces_;
    find_forces(t, h);
    const double now = change(from, h);
    if (std::isnan(now)) return Outcome::not_finite;
    if (now <= settled) {
      estimate(t, response);
      return nodes_.allFinite() ? Outcome::converged : Outcome::not_finite;
    }
    if (round > 2 && now > kContraction * before) return Outcome::diverged;
    before = now;
  }
  return Outcome::diverged;
}

void NodeForces::start(const State& from) {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    moved_(static_cast<Index>(k), 0) = from.x[active_[k]];
    moved_velocity_(static_cast<Index>(k), 0) = from.v[active_[k]];
  }
  x_.setZero();
  v_.setZero();
  find_forces(from.t, 0.0, 0);
  for (Index j = 1; j < kCount; ++j) forces_.col(j) = forces_.col(0);
}

void NodeForces::estimate(double t, const StepResponse& response) {
  const Eigen::MatrixXd nodes = nodes_, polynomial = polynomial_;
  const AtNodes moved = moved_;
  move(response, StepNodes::without_middle());
  // This alone moves the end hardly at all where the linear part is slow; what matters is how the contacts answer.
  find_forces(t, response.h());
  move(response, StepNodes::without_middle());
  error_ = nodes_.col(kEnd) - nodes.col(kEnd);
  // In equilibrium nothing but rounding is left.
  if (error_.norm() <= kRoundingOfEnd * (nodes.col(kEnd) - free_.col(kEnd)).norm()) error_.setZero();
  missed_ = polynomial_ - polynomial;
  nodes_ = nodes;
  polynomial_ = polynomial;
  moved_ = moved;
}

void NodeForces::end_at(double part, const StepResponse& response) {
  double power = 1.0;
  for (Index r = 0; r < kCount; ++r, power *= part) {
    polynomial_.col(r) *= power;
    missed_.col(r) *= power;
  }
  nodes_ = free_;
  response.add_force(polynomial_.data(), nodes_);
  error_.setZero();
  response.add_force_at_end(missed_.data(), error_);
}

double NodeForces::first_kink() const {
  const dynamics::Contact& contact = dynamics_.contact();
  const auto row = [&](Index dof) -> StepNodes::Row {
    if (dof < 0) return StepNodes::Row::Zero();
    return moved_.row(std::lower_bound(active_.begin(), active_.end(), dof) - active_.begin());
  };
  double first = 1.0;
  for (Index i = 0; i < contact.size(); ++i) {
    const StepNodes::Row motion = (row(contact.dof_a(i)) - row(contact.dof_b(i))) * StepNodes::with_middle();
    const model::Sides sides = contact.sides_of(i);
    if (sides != model::Sides::negative) first = StepNodes::first_crossing(motion, contact.gap_of(i), first);
    if (sides != model::Sides::positive) first = StepNodes::first_crossing(motion, -contact.gap_of(i), first);
  }
  return first;
}

}  // namespace butee::integrators

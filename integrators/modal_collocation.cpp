#include "integrators/modal_collocation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

using time::State;
using time::StepReport;
using time::StepStatus;

constexpr Index kCount = StepNodes::kCount, kMiddle = StepNodes::kMiddle, kEnd = StepNodes::kEnd;
/// The estimate is the error of a method of order 10, and itself falls with h^11. It is larger than the error; kappa =
/// 4 is a reserve for steps in which the force is hardly resolved.
constexpr LocalErrorControl::Orders kOrders = {.estimate = 11.0, .method = 10.0, .constant = 4.0, .kink = 1.0};
/// Sweeps end where they change velocities by this part of what a step may be wrong by.
constexpr double kSettled = 0.05;
constexpr int kMostSweeps = 25;
/// A sweep that changes the forces by more than this part of what the one before did will not come to an end soon.
constexpr double kContraction = 0.6;
/// The motion of contacts between nodes is resolved to this part of the tolerance.
constexpr double kResolved = 0.1;
/// A sine of w = |lambda| h differs from the polynomial through its values at the seven nodes by less than kMiss w^7:
/// 1/7! times the largest product of the distances from the nodes, 3e-4.
constexpr double kMiss = 3e-4 / 5040.0;
/// Modes may be missed by this part of the tolerance in outputs between nodes.
constexpr double kOutput = 0.01;
/// Tables that are kept; the lengths of cut steps are used once or twice.
constexpr std::size_t kTables = 12;
/// Steps that are redone since a stop opens or closes within, and how near to that they must end, in tolerances and
/// parts of a step.
constexpr int kMostCuts = 5;
constexpr double kCut = 1e-3, kCoarsestCut = 1e-6;
/// Looks at the motion of a stop over a step, and how much nearer than at the first of them the start must be to a
/// border to lie on it.
constexpr const char* kBends =
    "the law of a contact is not piecewise linear; the form of exponential for coupled modes and contacts in the plane "
    "would not see where it bends";
constexpr int kLooks = 32;
constexpr double kOnBorder = 1e-3;

[[noreturn]] void refuse(const std::string& reason) {
  throw InputError("integrator.type: " + reason +
                   "; take rodas4, dopri5, extrapolation8 or exact, or auto, which chooses among them");
}

/// Where a polynomial over [0, 1] first crosses a border before `last`; `last` where it does not.
double first_root(const Eigen::Matrix<double, 1, kCount>& polynomial, double border, double last) {
  const auto at = [&](double s) {
    double sum = 0.0;
    for (Index r = kCount - 1; r >= 0; --r) sum = sum * s + polynomial[r];
    return sum - border;
  };
  double begin = 0.0, at_begin = at(0.0);
  for (int k = 1; k <= kLooks; ++k) {
    double end = static_cast<double>(k) / kLooks, at_end = at(end);
    if (begin >= last) return last;
    if (k == 1 && std::abs(at_begin) <= kOnBorder * std::abs(at_end)) at_begin = at_end;
    if (at_begin * at_end < 0.0) {
      while (true) {
        const double middle = 0.5 * (begin + end);
        if (middle <= begin || middle >= end) return std::min(end, last);
        (at(middle) * at_begin > 0.0 ? begin : end) = middle;
      }
    }
    begin = end;
    at_begin = at_end;
  }
  return last;
}

}  // namespace

ModalCollocation::ModalCollocation(dynamics::Dynamics& dynamics, const Goal& goal)
    : Integrator(dynamics),
      control_(dynamics, goal, kOrders, LocalErrorControl::Steps::ladder),
      modes_(dynamics, goal.run_time),
      tolerance_(goal.tolerance),
      rate_(ErrorAccount(goal).rate()),
      event_precision_(std::min(1e-7, 1e-4 * goal.tolerance)),
      memory_begin_(LocalErrorControl::memory_size(dynamics.size())) {
  const Index n = dynamics.size(), p = modes_.count();
  const auto modal_shape = [&](const model::FreeLoad& load) {
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(2 * p);
    for (std::size_t i = 0; i < load.dofs.size(); ++i) shape += load.weights[i] * modes_.input().col(load.dofs[i]);
    return shape;
  };
  for (const model::FreeLoad& load : dynamics.system().loads) {
    const Eigen::VectorXd shape = modal_shape(load);
    const auto harmonic = load.in_time->harmonic();
    if (!harmonic && !load.in_time->is_piecewise_parabolic())
      refuse("a load is neither harmonic nor made of straight lines or parabolas in time, which this method needs");
    if (!harmonic) {
      other_loads_.push_back({load.in_time, shape});
      continue;
    }
    auto same = std::find_if(turning_loads_.begin(), turning_loads_.end(), [&](const TurningLoad& other) {
      return other.angular_frequency == harmonic->angular_frequency;
    });
    if (same == turning_loads_.end())
      same = turning_loads_.insert(
          same, {harmonic->angular_frequency, Eigen::VectorXd::Zero(2 * p), Eigen::VectorXd::Zero(2 * p)});
    const double c = 0.5 * harmonic->amplitude * std::cos(harmonic->phase),
                 s = 0.5 * harmonic->amplitude * std::sin(harmonic->phase);
    const auto add = [&](Eigen::VectorXd& factor, double sine) {
      factor.head(p) += c * shape.head(p) - sine * shape.tail(p);
      factor.tail(p) += c * shape.tail(p) + sine * shape.head(p);
    };
    add(same->forth, s);
    add(same->back, -s);
  }

  mobility_ = Vector::Zero(n);
  const auto take_dof = [&](Index dof, double stiffness) {
    if (dof < 0) return;
    contact_dofs_.push_back(dof);
    // Of velocities per impulse: the sum of what all modes hold.
    mobility_[dof] = modes_.velocity().col(dof).dot(modes_.input().col(dof));
    fastest_ = std::max(fastest_, std::sqrt(stiffness * std::max(mobility_[dof], 0.0)));
  };
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const model::ObstacleGroup& group = obstacles->group_of(i);
      if (group.law != nullptr && !group.law->is_piecewise_linear()) refuse(kBends);
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take_dof(dof, obstacles->closed_stiffness(i));
      needs_velocity_ = needs_velocity_ || group.damping.kind != model::ImpactDamping::Kind::none ||
                        group.friction.rule != model::Friction::Rule::none;
    }
  dynamics::Contact& contact = dynamics.contact();
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i) {
    if (!contact.law_of(i).is_piecewise_linear()) refuse(kBends);
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take_dof(dof, closed[i]);
  }
  std::sort(contact_dofs_.begin(), contact_dofs_.end());
  contact_dofs_.erase(std::unique(contact_dofs_.begin(), contact_dofs_.end()), contact_dofs_.end());
  reach_ = Eigen::ArrayXd::Zero(p);
  for (const Index dof : contact_dofs_) {
    const auto shape = modes_.displacement().col(dof).array();
    reach_ = reach_.max((shape.head(p).square() + shape.tail(p).square()).sqrt());
  }
  x_ = v_ = force_ = Vector::Zero(n);
  free_ = nodes_ = force_polynomial_ = load_polynomial_ = Eigen::MatrixXd::Zero(2 * p, kCount);
}

double ModalCollocation::first_step(const State&) const {
  double h = fastest_ > 0.0 ? 0.3 / fastest_ : std::numeric_limits<double>::infinity();
  for (const TurningLoad& load : turning_loads_)
    if (load.angular_frequency > 0.0) h = std::min(h, 1.0 / load.angular_frequency);
  const double slowest = modes_.count() > 0 ? modes_.speed()[0] : 0.0;
  if (slowest > 0.0) h = std::min(h, 1.0 / slowest);
  // On the ladder of steps, whose tables are kept.
  return std::isfinite(h) ? std::exp2(std::floor(4.0 * std::log2(h)) / 4.0) : h;
}

void ModalCollocation::do_start(State& state) {
  const Index p = modes_.count();
  state.memory.setZero(memory_begin_ + 2 * p * (1 + kCount));
  control_.start(state);
  modes_.to_modal(state.x, state.v, state.memory.segment(memory_begin_, 2 * p));
  step_end_ = std::numeric_limits<double>::quiet_NaN();
}

const ModalCollocation::Table& ModalCollocation::table(double h) {
  const auto found = std::find_if(tables_.begin(), tables_.end(), [h](const Table& table) { return table.h == h; });
  if (found != tables_.end()) {
    tables_.splice(tables_.begin(), tables_, found);
    return tables_.front();
  }
  if (tables_.size() >= kTables) tables_.pop_back();
  Table& made = tables_.emplace_front();
  made.h = h;
  for (Index j = 1; j < kCount; ++j)
    made.places.emplace_back(modes_, turning_loads_, StepNodes::kPlaces[static_cast<std::size_t>(j)], h);
  return made;
}

void ModalCollocation::find_active(const State& from) {
  (void)from;
  std::vector<Index> active;
  const auto take = [&](Index dof) {
    if (dof >= 0) active.push_back(dof);
  };
  if (const dynamics::Obstacles* obstacles = dynamics().obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const model::ObstacleGroup& group = obstacles->group_of(i);
      const bool is_idle = group.shape != nullptr &&
                           obstacles->phase(i).normal == dynamics::ContactPhase::Normal::apart &&
                           group.law->is_piecewise_linear() && group.law->secant(-1.0) == 0.0;
      if (is_idle) continue;
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take(dof);
    }
  const dynamics::Contact& contact = dynamics().contact();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take(dof);
  std::sort(active.begin(), active.end());
  active.erase(std::unique(active.begin(), active.end()), active.end());
  if (active == active_) return;
  active_ = std::move(active);
  const auto count = static_cast<Index>(active_.size());
  active_input_.resize(2 * modes_.count(), count);
  active_displacement_.resize(2 * modes_.count(), count);
  active_velocity_.resize(2 * modes_.count(), count);
  for (Index k = 0; k < count; ++k) {
    const Index dof = active_[static_cast<std::size_t>(k)];
    active_input_.col(k) = modes_.input().col(dof);
    active_displacement_.col(k) = modes_.displacement().col(dof);
    active_velocity_.col(k) = modes_.velocity().col(dof);
  }
  x_.setZero();
  v_.setZero();
}

void ModalCollocation::add_loads(double t, double h) {
  load_polynomial_.setZero();
  for (const OtherLoad& load : other_loads_) {
    Eigen::Matrix<double, 1, kCount> values;
    for (Index j = 0; j < kCount; ++j)
      values[j] = load.in_time->value(t + StepNodes::kPlaces[static_cast<std::size_t>(j)] * h);
    load_polynomial_.noalias() += load.shape * (values * StepNodes::with_middle());
  }
}

void ModalCollocation::find_forces(double t, double h, Index node) {
  for (std::size_t k = 0; k < active_.size(); ++k) {
    x_[active_[k]] = moved_(static_cast<Index>(k), node);
    if (needs_velocity_) v_[active_[k]] = moved_velocity_(static_cast<Index>(k), node);
    force_[active_[k]] = 0.0;
  }
  dynamics().add_contact_force(x_, force_);
  dynamics().add_obstacle_force(t + StepNodes::kPlaces[static_cast<std::size_t>(node)] * h, x_, v_, force_);
  for (std::size_t k = 0; k < active_.size(); ++k) forces_(static_cast<Index>(k), node) = force_[active_[k]];
}

double ModalCollocation::force_change(const State& from, double h) const {
  const auto scale_x = LocalErrorControl::scales_x(from), scale_v = LocalErrorControl::scales_v(from);
  double largest = 0.0;
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const Index dof = active_[k];
    const double change =
        h * mobility_[dof] *
        (forces_.row(static_cast<Index>(k)) - forces_before_.row(static_cast<Index>(k))).cwiseAbs().maxCoeff();
    if (!(change > 0.0)) {
      if (std::isnan(change)) return change;
      continue;
    }
    largest =
        std::max({largest, change / std::max(scale_v[dof], change), h * change / std::max(scale_x[dof], h * change)});
  }
  return largest;
}

void ModalCollocation::move_nodes(const Table& table, const StepNodes::Matrix& coefficients) {
  coefficients_.noalias() = forces_ * coefficients;
  force_polynomial_.noalias() = active_input_ * coefficients_;
  for (Index j = 1; j < kCount; ++j) {
    nodes_.col(j) = free_.col(j);
    table.places[static_cast<std::size_t>(j - 1)].add_force(force_polynomial_.data(), nodes_.col(j));
  }
}

void ModalCollocation::find_all_forces(double t, double h) {
  moved_.rightCols(kCount - 1).noalias() = active_displacement_.transpose() * nodes_.rightCols(kCount - 1);
  if (needs_velocity_)
    moved_velocity_.rightCols(kCount - 1).noalias() = active_velocity_.transpose() * nodes_.rightCols(kCount - 1);
  for (Index j = 1; j < kCount; ++j) find_forces(t, h, j);
}

ModalCollocation::Outcome ModalCollocation::sweep(const State& from, double h, const Table& table) {
  const double settled = kSettled * rate_ * h;
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostSweeps; ++round) {
    move_nodes(table, StepNodes::with_middle());
    forces_before_ = forces_;
    find_all_forces(from.t, h);
    const double change = force_change(from, h);
    if (std::isnan(change)) return Outcome::not_finite;
    if (change <= settled) {
      estimate(from, h, table);
      return nodes_.col(kEnd).allFinite() ? Outcome::converged : Outcome::not_finite;
    }
    if (round > 2 && change > kContraction * before) return Outcome::diverged;
    before = change;
  }
  return Outcome::diverged;
}

void ModalCollocation::estimate(const State& from, double h, const Table& table) {
  kept_nodes_ = nodes_;
  kept_polynomial_ = force_polynomial_;
  move_nodes(table, StepNodes::without_middle());
  // This alone moves the end hardly at all where the linear part is slow; what matters is how the contacts answer.
  find_all_forces(from.t, h);
  move_nodes(table, StepNodes::without_middle());
  kept_nodes_.swap(nodes_);
  kept_polynomial_.swap(force_polynomial_);
  const auto difference = (kept_nodes_.col(kEnd) - nodes_.col(kEnd)).eval();
  error_x_.noalias() = modes_.displacement().transpose() * difference;
  error_v_.noalias() = modes_.velocity().transpose() * difference;
}

double ModalCollocation::unresolved(const State& from, double h) const {
  if (contact_dofs_.empty()) return 0.0;
  const Index p = modes_.count();
  const double* const z = modal(from);
  double sum = 0.0;
  for (Index k = 0; k < p; ++k) {
    const double w = modes_.speed()[k] * h, w2 = w * w;
    sum += reach_[k] * std::hypot(z[k], z[p + k]) * std::min(2.0, kMiss * w2 * w2 * w2 * w);
  }
  double scale = 0.0;
  const auto scales = LocalErrorControl::scales_x(from);
  for (const Index dof : contact_dofs_) scale = std::max(scale, scales[dof]);
  return scale > 0.0 ? sum / scale : 0.0;
}

StepReport ModalCollocation::do_step(const State& from, const time::Step&, State& to) {
  const Index p = modes_.count();
  StepReport report;
  const double wanted = to.t - from.t;
  double h = wanted;
  find_active(from);
  const auto count = static_cast<Index>(active_.size());
  forces_.resize(count, kCount);
  moved_.resize(count, kCount);
  moved_velocity_.resize(count, kCount);
  const double coarse = unresolved(from, h) / (kResolved * tolerance_);
  if (coarse > 1.0) {
    report.error = 2.0;
    report.proposal =
        std::exp2(std::floor(4.0 * std::log2(h * std::max(0.1, 0.9 * std::pow(coarse, -1.0 / 7.0)))) / 4.0);
    return report;
  }
  for (int cut = 0;; ++cut) {
    const Table& responses = table(h);
    add_loads(from.t, h);
    const double* const loads = other_loads_.empty() ? nullptr : load_polynomial_.data();
    nodes_.col(0) = Eigen::Map<const Eigen::VectorXd>(modal(from), 2 * p);
    for (Index j = 1; j < kCount; ++j)
      responses.places[static_cast<std::size_t>(j - 1)].move(from.t, modal(from), loads, free_.col(j));
    error_x_ = error_v_ = Vector::Zero(from.x.size());
    force_polynomial_.setZero();
    if (count > 0) {
      for (Index k = 0; k < count; ++k) {
        moved_(k, 0) = from.x[active_[static_cast<std::size_t>(k)]];
        moved_velocity_(k, 0) = from.v[active_[static_cast<std::size_t>(k)]];
      }
      find_forces(from.t, h, 0);
      for (Index j = 1; j < kCount; ++j) forces_.col(j) = forces_.col(0);
      const Outcome outcome = sweep(from, h, responses);
      if (outcome == Outcome::not_finite) {
        report.status = StepStatus::not_finite;
        return report;
      }
      if (outcome == Outcome::diverged) {
        report.error = 2.0;
        report.proposal = std::exp2(std::floor(4.0 * std::log2(0.5 * h)) / 4.0);
        return report;
      }
    } else {
      nodes_ = free_;
      nodes_.col(0) = Eigen::Map<const Eigen::VectorXd>(modal(from), 2 * p);
    }
    if (dynamics().stop_count() == 0 || cut == kMostCuts) break;
    const double kink = first_kink();
    if (kink > 1.0 - std::min(kCoarsestCut, kCut * tolerance_) || !(from.t + kink * h > from.t)) break;
    h *= kink;
    to.t = from.t + h;
    ++report.inner_rejected;
  }
  step_begin_ = from.t;
  step_end_ = to.t;
  const auto end = nodes_.col(kEnd);
  to.memory.segment(memory_begin_, 2 * p) = end;
  Eigen::Map<Eigen::MatrixXd>(to.memory.data() + memory_begin_ + 2 * p, 2 * p, kCount) =
      force_polynomial_ + load_polynomial_;
  to.x.noalias() = modes_.displacement().transpose() * end;
  to.v.noalias() = modes_.velocity().transpose() * end;
  dynamics().acceleration(to.t, to.x, to.v, to.a);
  control_.judge(from, to, h, error_x_, error_v_, report);
  if (report.error <= 1.0 && coarse > 0.0)
    report.proposal =
        std::min(report.proposal, std::exp2(std::floor(4.0 * std::log2(h * 0.9 * std::pow(coarse, -1.0 / 7.0))) / 4.0));
  // A step that a stop cut short says nothing against longer ones.
  if (h < wanted && report.error <= 1.0) report.proposal = std::max(report.proposal, wanted);
  return report;
}

double ModalCollocation::first_kink() const {
  const dynamics::Contact& contact = dynamics().contact();
  const auto row = [&](Index dof) -> Eigen::Matrix<double, 1, kCount> {
    if (dof < 0) return Eigen::Matrix<double, 1, kCount>::Zero();
    return moved_.row(std::lower_bound(active_.begin(), active_.end(), dof) - active_.begin());
  };
  double first = 1.0;
  for (Index i = 0; i < contact.size(); ++i) {
    const Eigen::Matrix<double, 1, kCount> motion =
        (row(contact.dof_a(i)) - row(contact.dof_b(i))) * StepNodes::with_middle();
    const model::Sides sides = contact.sides_of(i);
    if (sides != model::Sides::negative) first = first_root(motion, contact.gap_of(i), first);
    if (sides != model::Sides::positive) first = first_root(motion, -contact.gap_of(i), first);
  }
  return first;
}

std::span<const double> ModalCollocation::knots(const State& from, const State& to) const {
  for (std::size_t j = 0; j < knots_.size(); ++j) knots_[j] = from.t + StepNodes::kPlaces[j] * (to.t - from.t);
  return std::span(knots_).subspan(1, kCount - 2);
}

std::optional<Index> ModalCollocation::node_at(const State& from, const State& to, double t) const {
  if (from.t != step_begin_ || to.t != step_end_) return std::nullopt;
  for (Index j = 0; j < kCount; ++j)
    if (t == from.t + StepNodes::kPlaces[static_cast<std::size_t>(j)] * (to.t - from.t)) return j;
  return std::nullopt;
}

void ModalCollocation::move_to(const State& from, const State& to, double place, Eigen::VectorXd& z) const {
  const Index p = modes_.count();
  const double h = to.t - from.t;
  Index slow = 0;
  if (from.t == step_begin_ && to.t == step_end_) {
    // Slow modes by the polynomial through the nodes, which misses them by kMiss (|lambda| h)^7 of their size.
    const double most = std::pow(kOutput * tolerance_ / kMiss, 1.0 / 7.0) / h;
    while (slow < p && modes_.speed()[slow] <= most) ++slow;
    const auto weights = StepNodes::lagrange(place);
    z.head(slow).noalias() = nodes_.topRows(slow) * weights;
    z.segment(p, slow).noalias() = nodes_.middleRows(p, slow) * weights;
  }
  if (slow < p)
    PlaceResponse(modes_, turning_loads_, place, h, slow)
        .move(from.t, modal(from), to.memory.data() + memory_begin_ + 2 * p, z);
}

void ModalCollocation::do_interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                                      time::Interpolated out) const {
  const Index p = modes_.count();
  const double h = to.t - from.t, place = (t - from.t) / h;
  const Eigen::Map<const Eigen::MatrixXd> forces(to.memory.data() + memory_begin_ + 2 * p, 2 * p, kCount);
  Eigen::VectorXd z(2 * p);
  const auto node = node_at(from, to, t);
  if (node)
    z = nodes_.col(*node);
  else if (place <= 0.0)
    z = Eigen::Map<const Eigen::VectorXd>(modal(from), 2 * p);
  else
    move_to(from, to, place, z);
  Eigen::VectorXd rate;
  if (!out.a.empty()) {
    rate.resize(2 * p);
    rate.head(p).array() = modes_.decay() * z.head(p).array() - modes_.turn() * z.tail(p).array();
    rate.tail(p).array() = modes_.decay() * z.tail(p).array() + modes_.turn() * z.head(p).array();
    double power = 1.0;
    for (Index r = 0; r < kCount; ++r, power *= place) rate += power * forces.col(r);
    for (const TurningLoad& load : turning_loads_) {
      const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
      rate.head(p) += c * (load.forth.head(p) + load.back.head(p)) - s * (load.forth.tail(p) - load.back.tail(p));
      rate.tail(p) += c * (load.forth.tail(p) + load.back.tail(p)) + s * (load.forth.head(p) - load.back.head(p));
    }
  }
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (!out.x.empty()) out.x[i] = modes_.displacement().col(dofs[i]).dot(z);
    if (!out.v.empty()) out.v[i] = modes_.velocity().col(dofs[i]).dot(z);
    if (!out.a.empty()) out.a[i] = modes_.velocity().col(dofs[i]).dot(rate);
  }
}

void ModalCollocation::do_trace(const State& from, const State& to, double t, std::span<const Index> dofs,
                                time::Interpolated out) const {
  if (from.t != step_begin_ || to.t != step_end_ || !out.a.empty()) return do_interpolate(from, to, t, dofs, out);
  const auto weights = StepNodes::lagrange((t - from.t) / (to.t - from.t));
  const Eigen::VectorXd z = nodes_ * weights;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (!out.x.empty()) out.x[i] = modes_.displacement().col(dofs[i]).dot(z);
    if (!out.v.empty()) out.v[i] = modes_.velocity().col(dofs[i]).dot(z);
  }
}

}  // namespace butee::integrators

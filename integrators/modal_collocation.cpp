#include "integrators/modal_collocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {
namespace {

using time::State;
using time::StepReport;
using time::StepStatus;

constexpr Index kCount = StepNodes::kCount;
/// The estimate is the error of a method of order 10, and itself falls with h^11. It is larger than the error; kappa =
/// 4 is a reserve for steps in which the force is hardly resolved.
constexpr LocalErrorControl::Orders kOrders = {.estimate = 11.0, .method = 10.0, .constant = 4.0, .kink = 1.0};
/// Sweeps end where they change velocities by this part of what a step may be wrong by.
constexpr double kSettled = 0.05;
/// The motion of contacts between nodes is resolved to this part of the tolerance.
constexpr double kResolved = 0.1;
/// Modes may be missed by this part of the tolerance in outputs between nodes.
constexpr double kOutput = 0.01;
/// Responses that are kept; those of steps that were cut short are used once or twice.
constexpr std::size_t kKept = 12;
/// A step is redone so often because a stop opens or closes within it. It must end as near to that as kCut tolerances,
/// and kCoarsestCut, parts of its length.
constexpr int kMostCuts = 5;
constexpr double kCut = 1e-3, kCoarsestCut = 1e-6;

/// The longest step of the ladder 2^(k/4) s that is no longer than h.
double on_ladder(double h) {
  return std::exp2(std::floor(4.0 * std::log2(h)) / 4.0);
}

/// The factor by which a step changes whose motion between nodes is `coarse` times as coarse as it may be.
double by_resolution(double coarse) {
  return 0.9 * std::pow(coarse, -1.0 / 7.0);
}

}  // namespace

ModalCollocation::ModalCollocation(dynamics::Dynamics& dynamics, const Goal& goal)
    : Integrator(dynamics),
      control_(dynamics, goal, kOrders, LocalErrorControl::Steps::ladder),
      modes_(dynamics, goal.run_time),
      loads_(modes_, dynamics.system()),
      forces_(dynamics, modes_),
      tolerance_(goal.tolerance),
      rate_(ErrorAccount(goal).rate()),
      memory_begin_(LocalErrorControl::memory_size(dynamics.size())),
      traced_(static_cast<std::size_t>(dynamics.size())),
      traced_x_(kCount, dynamics.size()),
      traced_v_(kCount, dynamics.size()) {}

double ModalCollocation::first_step(const State&) const {
  constexpr double kOfContact = 0.3;
  const double frequency = std::max({forces_.highest_frequency() / kOfContact, loads_.highest_frequency(),
                                     modes_.count() > 0 ? modes_.speed()[0] : 0.0});
  return frequency > 0.0 ? on_ladder(1.0 / frequency) : std::numeric_limits<double>::infinity();
}

void ModalCollocation::do_start(State& state) {
  const Index p = modes_.count();
  state.memory.setZero(memory_begin_ + 2 * p * (1 + kCount));
  control_.start(state);
  modes_.to_modal(state.x, state.v, state.memory.segment(memory_begin_, 2 * p));
  step_end_ = std::numeric_limits<double>::quiet_NaN();
}

const StepResponse& ModalCollocation::response(double h) {
  const auto found =
      std::find_if(responses_.begin(), responses_.end(), [h](const StepResponse& kept) { return kept.h() == h; });
  if (found != responses_.end()) {
    responses_.splice(responses_.begin(), responses_, found);
    return responses_.front();
  }
  if (responses_.size() >= kKept) responses_.pop_back();
  return responses_.emplace_front(modes_, loads_.turning(), h);
}

StepReport ModalCollocation::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report;
  if (step.is_part && from.t == step_begin_ && to.t <= solved_end_ && end_at(from, to, report)) return report;
  step_end_ = std::numeric_limits<double>::quiet_NaN();
  const auto redo_with = [&report](double h) {
    report.error = 2.0;
    report.proposal = on_ladder(h);
    return report;
  };
  const double wanted = to.t - from.t,
               coarse = forces_.unresolved(from, modal(from), wanted) / (kResolved * tolerance_);
  if (coarse > 1.0) return redo_with(wanted * std::max(0.1, by_resolution(coarse)));
  double h = wanted;
  for (int cut = 0;; ++cut) {
    const StepResponse& response = this->response(h);
    const double* const loads = loads_.has_others() ? loads_.polynomial(from.t, h).data() : nullptr;
    response.move(from.t, modal(from), loads, forces_.free_nodes());
    const auto outcome = forces_.find(from, response, kSettled * rate_ * h);
    if (outcome == NodeForces::Outcome::diverged) return redo_with(0.5 * h);
    if (outcome == NodeForces::Outcome::not_finite) {
      report.status = StepStatus::not_finite;
      return report;
    }
    if (dynamics().stop_count() == 0 || cut == kMostCuts) break;
    const double kink = forces_.first_kink();
    if (kink > 1.0 - std::min(kCoarsestCut, kCut * tolerance_) || !(from.t + kink * h > from.t)) break;
    h *= kink;
    to.t = from.t + h;
    ++report.inner_rejected;
  }
  accept(from, h, to);
  solved_end_ = to.t;
  judge(from, to, h, report);
  if (report.error > 1.0) return report;
  if (coarse > 0.0) report.proposal = std::min(report.proposal, on_ladder(h * by_resolution(coarse)));
  // A step that a stop cut short says nothing against longer ones.
  if (h < wanted) report.proposal = std::max(report.proposal, wanted);
  return report;
}

bool ModalCollocation::end_at(const State& from, State& to, StepReport& report) {
  const double h = to.t - from.t;
  const StepResponse response(modes_, loads_.turning(), h);
  response.move(from.t, modal(from), loads_.has_others() ? loads_.polynomial(from.t, h).data() : nullptr,
                forces_.free_nodes());
  forces_.end_at(h / (step_end_ - step_begin_), response);
  accept(from, h, to);
  judge(from, to, h, report);
  if (report.error <= 1.0) return true;
  report = {};
  return false;
}

void ModalCollocation::judge(const State& from, State& to, double h, StepReport& report) {
  const Vector error_x = modes_.displacement().transpose() * forces_.error(),
               error_v = modes_.velocity().transpose() * forces_.error();
  control_.judge(from, to, h, error_x, error_v, report);
}

void ModalCollocation::accept(const State& from, double h, State& to) {
  const Index p = modes_.count();
  step_begin_ = from.t;
  step_end_ = to.t;
  ++accepted_;
  const auto end = forces_.nodes().col(StepNodes::kEnd);
  to.memory.segment(memory_begin_, 2 * p) = end;
  Eigen::Map<Eigen::MatrixXd> polynomial(to.memory.data() + memory_begin_ + 2 * p, 2 * p, kCount);
  polynomial = forces_.polynomial();
  if (loads_.has_others()) polynomial += loads_.polynomial(from.t, h);
  to.x.noalias() = modes_.displacement().transpose() * end;
  to.v.noalias() = modes_.velocity().transpose() * end;
  dynamics().acceleration(to.t, to.x, to.v, to.a);
}

std::span<const double> ModalCollocation::knots(const State& from, const State& to) const {
  for (std::size_t j = 0; j < knots_.size(); ++j) knots_[j] = from.t + StepNodes::kPlaces[j] * (to.t - from.t);
  return std::span(knots_).subspan(1, kCount - 2);
}

std::optional<Index> ModalCollocation::node_at(const State& from, const State& to, double t) const {
  if (!holds(from, to)) return std::nullopt;
  for (Index j = 0; j < kCount; ++j)
    if (t == from.t + StepNodes::kPlaces[static_cast<std::size_t>(j)] * (to.t - from.t)) return j;
  return std::nullopt;
}

void ModalCollocation::move_to(const State& from, const State& to, double place, Eigen::VectorXd& z) const {
  const Index p = modes_.count();
  const double h = to.t - from.t;
  Index slow = 0;
  if (holds(from, to)) {
    // Slow modes by the polynomial through the nodes, which misses them by StepNodes::kMiss (|lambda| h)^7 of their
    // size.
    const double most = std::pow(kOutput * tolerance_ / StepNodes::kMiss, 1.0 / 7.0) / h;
    while (slow < p && modes_.speed()[slow] <= most) ++slow;
    const auto weights = StepNodes::lagrange(place);
    z.head(slow).noalias() = forces_.nodes().topRows(slow) * weights;
    z.segment(p, slow).noalias() = forces_.nodes().middleRows(p, slow) * weights;
  }
  if (slow < p)
    PlaceResponse(modes_, loads_.turning(), place, h, slow)
        .move(from.t, modal(from), to.memory.data() + memory_begin_ + 2 * p, z);
}

void ModalCollocation::do_interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                                      time::Interpolated out) const {
  const Index p = modes_.count();
  const double h = to.t - from.t, place = (t - from.t) / h;
  const Eigen::Map<const Eigen::MatrixXd> polynomial(to.memory.data() + memory_begin_ + 2 * p, 2 * p, kCount);
  Eigen::VectorXd z(2 * p);
  const auto node = node_at(from, to, t);
  if (node)
    z = forces_.nodes().col(*node);
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
    for (Index r = 0; r < kCount; ++r, power *= place) rate += power * polynomial.col(r);
    loads_.add_turning(t, rate);
  }
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (!out.x.empty()) out.x[i] = modes_.displacement().col(dofs[i]).dot(z);
    if (!out.v.empty()) out.v[i] = modes_.velocity().col(dofs[i]).dot(z);
    if (!out.a.empty()) out.a[i] = modes_.velocity().col(dofs[i]).dot(rate);
  }
}

void ModalCollocation::do_trace(const State& from, const State& to, double t, std::span<const Index> dofs,
                                time::Interpolated out) const {
  if (!holds(from, to) || !out.a.empty()) return do_interpolate(from, to, t, dofs, out);
  const auto weights = StepNodes::lagrange((t - from.t) / (to.t - from.t));
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Index dof = dofs[i];
    if (auto& traced = traced_[static_cast<std::size_t>(dof)]; traced != accepted_) {
      traced = accepted_;
      traced_x_.col(dof).noalias() = forces_.nodes().transpose() * modes_.displacement().col(dof);
      traced_v_.col(dof).noalias() = forces_.nodes().transpose() * modes_.velocity().col(dof);
    }
    if (!out.x.empty()) out.x[i] = weights.dot(traced_x_.col(dof));
    if (!out.v.empty()) out.v[i] = weights.dot(traced_v_.col(dof));
  }
}

}  // namespace butee::integrators

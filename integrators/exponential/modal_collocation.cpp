#include "integrators/exponential/modal_collocation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

namespace butee::integrators {
namespace {

using time::State;
using time::StepReport;
using time::StepStatus;

constexpr Index kCount = StepNodes::kCount;
/// The estimate falls with h^11, as the local error of a method of order 10.
constexpr LocalErrorControl::Orders kOrders = {
    .estimate = 11.0, .method = 10.0, .constant = 1.0, .contact_change = 1.0, .is_linear_part_exact = true};
/// Sweeps end if they change velocities by less than this fraction of the allowed error of the
/// step.
constexpr double kSettled = 0.05;
/// Allowed interpolation error of the contacts' motion between nodes, as a fraction of the
/// tolerance.
constexpr double kResolved = 0.1;
/// Allowed error of the contacts' velocities within a step, as a fraction of the tolerance.
constexpr double kInner = 1.0;
/// An unbalance of varying speed turns by less than this in a step, rad, so that its forces at the nodes show its
/// motion; the error control shortens steps further.
constexpr double kMostTurn = 3.0;
/// Number of step responses kept; those of shortened steps are used once or twice.
constexpr std::size_t kKept = 12;
/// A step is shortened at most kMostCuts times because a stop opens or closes within it. It must
/// end within kCut times the tolerance, at most kCoarsestCut, of that change, as a fraction of its
/// length.
constexpr int kMostCuts = 5;
constexpr double kCut = 1e-3, kCoarsestCut = 1e-6;
/// A step that follows a shortened one starts on a border, up to the error of the located position. Crossings of that
/// border within this fraction of the step are therefore the same change. Without this, a contact that touches a border
/// and returns would end step after step there.
constexpr double kSameChange = 1e-3;
/// Behind the end of a shortened step a change is searched over this fraction of its length.
constexpr double kBeyond = 0.02;

/// The longest step of the geometric grid 2^(k/4) s that does not exceed h.
double on_grid(double h) {
  return std::exp2(std::floor(4.0 * std::log2(h)) / 4.0);
}

/// The step size factor if the interpolation error between nodes is `coarse` times its bound.
double by_resolution(double coarse) {
  return 0.9 * std::pow(coarse, -1.0 / 7.0);
}

/// The step size factor if the error of velocities within the step is `inner` times its bound.
double by_inner(double inner) {
  return 0.9 * std::pow(inner, -1.0 / 8.0);
}

}  // namespace

ModalCollocation::ModalCollocation(dynamics::Dynamics& dynamics, const Goal& goal, Index most_coupled)
    : Integrator(dynamics),
      control_(dynamics, goal, kOrders, LocalErrorControl::Steps::geometric),
      modes_(dynamics, goal.run_time, most_coupled),
      loads_(modes_, dynamics.system()),
      forces_(dynamics, modes_),
      all_dofs_(modes_),
      tolerance_(goal.tolerance),
      rate_(ErrorAccount(goal).rate()),
      memory_begin_(LocalErrorControl::memory_size(dynamics.size())),
      of_part_(modes_, loads_.harmonic()),
      outputs_(modes_, loads_, forces_.dofs().all(), goal.tolerance, memory_begin_) {
  std::vector<Index> all(static_cast<std::size_t>(dynamics.size()));
  std::iota(all.begin(), all.end(), Index{0});
  all_dofs_.choose(all);
}

double ModalCollocation::first_step(const State&) const {
  constexpr double kOfContact = 0.3;
  const double frequency =
      std::max({forces_.dofs().highest_frequency() / kOfContact, loads_.highest_frequency(),
                forces_.varying().highest_frequency(), modes_.count() > 0 ? modes_.speed()[0] : 0.0});
  return frequency > 0.0 ? on_grid(1.0 / frequency) : std::numeric_limits<double>::infinity();
}

void ModalCollocation::do_start(State& state) {
  const Index p = modes_.count();
  state.memory.setZero(memory_begin_ + 2 * p * (1 + kCount) + 1);
  control_.start(state);
  modes_.to_modal(state.x, state.v, state.memory.segment(memory_begin_, 2 * p));
  step_end_ = std::numeric_limits<double>::quiet_NaN();
  outputs_.reset();
}

const StepResponse& ModalCollocation::response(double h) {
  const auto found =
      std::find_if(responses_.begin(), responses_.end(), [h](const StepResponse& kept) { return kept.h() == h; });
  if (found != responses_.end()) {
    responses_.splice(responses_.begin(), responses_, found);
    return responses_.front();
  }
  if (responses_.size() < kKept)
    responses_.emplace_front(modes_, loads_.harmonic());
  else
    responses_.splice(responses_.begin(), responses_, std::prev(responses_.end()));
  responses_.front().set(h);
  return responses_.front();
}

StepReport ModalCollocation::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report;
  if (step.is_part && from.t == step_begin_ && to.t <= solved_end_ && end_at(from, to, report)) return report;
  step_end_ = std::numeric_limits<double>::quiet_NaN();
  are_nodes_known_ = true;
  outputs_.reset();
  const auto redo_with = [&report](double h) {
    report.error = 2.0;
    report.proposal = on_grid(h);
    return report;
  };
  const double wanted = to.t - from.t,
               coarse = forces_.unresolved(from, modal(from), loads_, wanted) / (kResolved * tolerance_);
  // Far from all contacts their motion between the nodes does not matter.
  const bool is_far = coarse > 0.0 && forces_.stays_apart(modal(from));
  if (coarse > 1.0 && !is_far) return redo_with(wanted * std::max(0.1, by_resolution(coarse)));
  if (const double turn = forces_.varying().highest_frequency() * wanted; turn > kMostTurn)
    return redo_with(wanted * kMostTurn / turn);
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
    if (!forces_.has_borders() || cut == kMostCuts) break;
    // The forces behind a change shift its computed position, so that a shortened step may end
    // before the change.
    const double beyond = cut > 0 ? std::min(1.0 + kBeyond, wanted / h) : 1.0,
                 begin = was_shortened(from) ? kSameChange * wanted / h : 0.0,
                 change = forces_.first_contact_change(from.t, h, {std::min(begin, beyond), beyond},
                                                       control_.is_still(from));
    if (change >= beyond || std::abs(change - 1.0) <= std::min(kCoarsestCut, kCut * tolerance_) ||
        !(from.t + change * h > from.t))
      break;
    h *= change;
    to.t = from.t + h;
    ++report.inner_rejected;
  }
  if (coarse > 1.0 && !forces_.stays_apart()) return redo_with(h * std::max(0.1, by_resolution(coarse)));
  accept(from, h, to);
  to.memory.tail(1)[0] = h < wanted ? 1.0 : 0.0;
  judge(from, to, h, report);
  // This needs the scales of `to`, which judge() finds.
  const CollocationOutputs::Longest longest = outputs_.longest(from, to);
  if (h > longest.here) return redo_with(longest.here);
  solved_end_ = to.t;
  if (report.error > 1.0) return report;
  const double inner = control_.is_still(to) ? 0.0 : forces_.inner_error(from, to) / (kInner * tolerance_);
  if (inner > 1.0) return redo_with(h * std::max(0.1, by_inner(inner)));
  if (inner > 0.0) report.proposal = std::min(report.proposal, on_grid(h * by_inner(inner)));
  if (coarse > 0.0 && !is_far) report.proposal = std::min(report.proposal, on_grid(h * by_resolution(coarse)));
  // A step shortened by a change of contact does not limit the next step.
  if (h < wanted) report.proposal = std::max(report.proposal, wanted);
  report.proposal = std::min(report.proposal, on_grid(longest.next));
  return report;
}

bool ModalCollocation::end_at(const State& from, State& to, StepReport& report) {
  const double h = to.t - from.t;
  forces_.end_at(h / (step_end_ - step_begin_), from.t, modal(from),
                 loads_.has_others() ? loads_.polynomial(from.t, h).data() : nullptr,
                 PlaceResponse(modes_, loads_.harmonic(), 1.0, h));
  are_nodes_known_ = false;
  accept(from, h, to);
  to.memory.tail(1)[0] = 0.0;
  judge(from, to, h, report);
  if (report.error <= 1.0) return true;
  report = {};
  return false;
}

time::Interpolant& ModalCollocation::interpolant() {
  if (!are_nodes_known_) {
    const double h = step_end_ - step_begin_;
    of_part_.set(h);
    forces_.find_nodes(step_begin_, loads_.has_others() ? loads_.polynomial(step_begin_, h).data() : nullptr, of_part_);
    are_nodes_known_ = true;
  }
  return outputs_;
}

void ModalCollocation::judge(const State& from, State& to, double h, StepReport& report) {
  const Vector error_x = motion_.col(1), error_v = motion_.col(3);
  control_.judge(from, to, h, error_x, error_v, report);
}

void ModalCollocation::accept(const State& from, double h, State& to) {
  const Index p = modes_.count();
  step_begin_ = from.t;
  step_end_ = to.t;
  outputs_.accept(from.t, to.t, forces_.nodes());
  const Eigen::VectorXd& end = forces_.end();
  to.memory.segment(memory_begin_, 2 * p) = end;
  Eigen::Map<Eigen::MatrixXd> polynomial(to.memory.data() + memory_begin_ + 2 * p, 2 * p, kCount);
  polynomial = forces_.polynomial().leftCols<kCount>();
  if (loads_.has_others()) polynomial += loads_.polynomial(from.t, h);
  all_dofs_.motions(end, forces_.error(), motion_);
  to.x = motion_.col(0);
  to.v = motion_.col(2);
  dynamics().acceleration(to.t, to.x, to.v, to.a);
}

}  // namespace butee::integrators

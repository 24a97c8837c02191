#include "integrators/piecewise_motion.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// A step ends where it has so many pieces.
constexpr std::size_t kMostPieces = 256;
/// So many changes of each stop at one instant are chatter by rounding.
constexpr std::size_t kMostAtOnce = 6;
/// So many changes of each stop at one instant end the run with a message.
constexpr std::size_t kHopeless = 1000;
/// The turn between two breakpoints, rad.
constexpr double kTurn = 1.5;
/// A step ends where the motion has turned so far, rad: outputs examine every breakpoint, and a run can be interrupted
/// between steps.
constexpr double kMostTurn = 1e4;
/// In a step of kMostTurn there are fewer, unless faster motion that was below 1e-9 of the rest comes out of its decay.
constexpr std::size_t kMostBreakpoints = 100000;

}  // namespace

PiecewiseMotion::PiecewiseMotion(dynamics::Dynamics& dynamics, double end_time)
    : counters_(dynamics.counters()),
      system_(dynamics),
      first_change_(system_),
      end_time_(end_time),
      discontinuities_(dynamics.load_discontinuities()),
      status_(static_cast<std::size_t>(system_.stop_count())),
      closed_(status_.size()),
      x_(static_cast<std::size_t>(system_.size())),
      v_(x_.size()),
      force_(Eigen::MatrixXd::Zero(system_.size() + system_.stop_count(), 3)) {
  has_dashpots_ = std::any_of(system_.stops.begin(), system_.stops.end(),
                              [](const LinearStop& stop) { return stop.damping > 0.0; });
  states_.reserve(kMostStates);
  flow();  // Refuses what has no modes before the first step.
}

void PiecewiseMotion::write_status(const time::State& at, VectorRef memory) const {
  memory.tail(2) << -1.0, 0.0;
  for (Index i = 0; i < system_.stop_count(); ++i) {
    const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
    const double w = stop.displacement(at.x.data()), v = stop.displacement(at.v.data());
    const double side = stop.positive && (w > 0.0 || !stop.negative) ? 1.0 : -1.0, g = side * w - stop.gap;
    StopStatus status = kOpen;
    if (stop.always_closed)
      status = kClosed;
    else if (g > 0.0)
      status = on_side(
          stop.damping > 0.0 && !stop.pulls && stop.stiffness * g + stop.damping * side * v < 0.0 ? kReleased : kClosed,
          side);
    memory[i] = status;
  }
}

void PiecewiseMotion::write_end(time::State& to) const {
  for (Index i = 0; i < to.x.size(); ++i) {
    const Jet jet = motion_of(i);
    to.x[i] = jet[0];
    to.v[i] = jet[1];
    to.a[i] = jet[2];
  }
  for (std::size_t i = 0; i < status_.size(); ++i) to.memory[static_cast<Index>(i)] = status_[i];
  to.memory.tail(2) << static_cast<double>(changed_.stop), changed_.uncertainty;
  to.t = end_t_;
}

void PiecewiseMotion::follow(const time::State& from, const time::Step& step) {
  end_t_ = kNever;
  has_breakpoints_ = false;
  from_x_ = from.x;
  from_v_ = from.v;
  from_memory_ = from.memory;
  begins_.clear();
  begin_x_.clear();
  begin_v_.clear();
  begin_status_.clear();
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = from.x[static_cast<Index>(i)];
    v_[i] = from.v[static_cast<Index>(i)];
  }
  for (std::size_t i = 0; i < status_.size(); ++i)
    status_[i] = static_cast<StopStatus>(from.memory[static_cast<Index>(i)]);
  double t = from.t;
  double turn = kMostTurn;   // that is left, rad
  std::size_t at_once = 0;   // changes at the present instant
  double uncertainty = 0.0;  // the largest of theirs, m
  changed_ = {static_cast<Index>(from.memory[system_.stop_count()]), from.memory[system_.stop_count() + 1]};
  while (true) {
    try {
      begin_piece(t);
    } catch (const RunError&) {
      // The step ends before a contact state that has no modes; the next one fails.
      if (begins_.empty()) throw;
      break;
    }
    const ContactStateFlow& flow = *flow_;
    const double landing = std::min(step.t_end, next_discontinuity(t)), rest = landing - t, rate = flow.rate(piece_),
                 until = std::min({rest, flow.longest(), turn / rate});
    const std::int64_t looks = first_change_.looks();
    const bool chatters = at_once > kMostAtOnce * (status_.size() + 1);
    const auto found = first_change_.find(flow, piece_, status_, until, changed_,
                                          chatters ? std::optional(uncertainty) : std::nullopt);
    counters_.law_evaluations += first_change_.looks() - looks;
    const double t_next = found.s < rest ? std::min(t + found.s, landing) : landing;
    const bool has_passed = t_next > t;
    if (has_passed) {
      begins_.push_back(t);
      begin_x_.insert(begin_x_.end(), x_.begin(), x_.end());
      begin_v_.insert(begin_v_.end(), v_.begin(), v_.end());
      begin_status_.insert(begin_status_.end(), status_.begin(), status_.end());
    }
    at_once = has_passed ? 0 : at_once + 1;
    if (has_passed) uncertainty = 0.0;
    if (at_once > kHopeless * (status_.size() + 1))
      throw RunError("stops open and close without end at t = " + to_text(t) + " s; take exact, rodas4 or dopri5");
    flow.go(piece_, std::min(found.s, rest));
    changed_ = {};
    if (found.change) {
      changed_ = {found.change->stop, found.change->uncertainty};
      uncertainty = std::max(uncertainty, found.change->uncertainty);
    }
    if (found.change) status_[static_cast<std::size_t>(found.change->stop)] = found.change->to;
    t = t_next;
    turn -= rate * found.s;
    const bool is_full = begins_.size() == kMostPieces || turn < kTurn;
    if (has_passed && (t >= step.t_end || is_full || step.single)) break;
    if (found.s == 0.0) continue;  // x_ and v_ are exact
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Jet jet = flow.dof(piece_, static_cast<Index>(i));
      x_[i] = jet[0];
      v_[i] = jet[1];
    }
  }
  end_t_ = t;
  loaded_ = begins_.size() - 1;
}

const ContactStateFlow& PiecewiseMotion::flow() {
  for (std::size_t i = 0; i < status_.size(); ++i) closed_[i] = is_closed(status_[i]) || system_.stops[i].always_closed;
  ++uses_;
  const auto is_it = [&](const State& state) { return state.closed == closed_; };
  if (current_ < states_.size() && is_it(states_[current_])) {
    states_[current_].used = uses_;
    return *states_[current_].flow;
  }
  auto found = std::find_if(states_.begin(), states_.end(), is_it);
  if (found == states_.end()) {
    auto made = std::make_unique<ContactStateFlow>(system_, closed_, end_time_);
    if (states_.size() < kMostStates)
      found = states_.insert(states_.end(), State{});
    else
      found = std::min_element(states_.begin(), states_.end(),
                               [](const State& a, const State& b) { return a.used < b.used; });
    found->closed = closed_;
    found->flow = std::move(made);
  }
  found->used = uses_;
  current_ = static_cast<std::size_t>(found - states_.begin());
  return *found->flow;
}

void PiecewiseMotion::begin_piece(double t) {
  const ContactStateFlow& now = flow();
  force_.setZero();
  bool has_force = system_.add_polynomials(t, force_);
  for (std::size_t i = 0; i < status_.size(); ++i) {
    const LinearStop& stop = system_.stops[i];
    if (!is_closed(status_[i]) || stop.gap == 0.0) continue;
    force_(system_.size() + static_cast<Index>(i), 0) = status_[i] * stop.stiffness * stop.gap;
    has_force = true;
  }
  now.begin(t, x_.data(), v_.data(), force_, has_force, next_discontinuity(t) - t, piece_);
  flow_ = &now;
}

double PiecewiseMotion::next_discontinuity(double t) const {
  const auto next = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), t);
  return next == discontinuities_.end() ? kNever : *next;
}

void PiecewiseMotion::recall(const time::State& from, const time::State& to) {
  // The first piece may begin within rounding of `from`: stops may have changed at its instant.
  const bool holds = to.t == end_t_ && !begins_.empty() && begins_.front() == from.t && from.x == from_x_ &&
                     from.v == from_v_ && from.memory == from_memory_;
  if (!holds) follow(from, {to.t - from.t, to.t});
}

void PiecewiseMotion::load_piece(std::size_t piece) {
  if (piece == loaded_) return;
  const std::size_t n = x_.size(), m = status_.size();
  std::copy_n(begin_x_.begin() + static_cast<std::ptrdiff_t>(piece * n), n, x_.begin());
  std::copy_n(begin_v_.begin() + static_cast<std::ptrdiff_t>(piece * n), n, v_.begin());
  std::copy_n(begin_status_.begin() + static_cast<std::ptrdiff_t>(piece * m), m, status_.begin());
  loaded_ = kNoPiece;
  begin_piece(begins_[piece]);
  loaded_ = piece;
}

void PiecewiseMotion::go_to(double t) {
  const auto after = std::upper_bound(begins_.begin(), begins_.end(), t);
  const auto piece = static_cast<std::size_t>(after - begins_.begin());
  load_piece(piece == 0 ? 0 : piece - 1);
  flow_->go(piece_, t - piece_.t);
}

void PiecewiseMotion::find_breakpoints() {
  breakpoints_.clear();
  has_breakpoints_ = true;
  for (std::size_t piece = 0; piece < begins_.size(); ++piece) {
    const double begin = begins_[piece], end = piece + 1 < begins_.size() ? begins_[piece + 1] : end_t_;
    if (piece > 0) {
      // Accelerations may jump at the end of the piece before.
      const bool jumps = has_dashpots_ || std::binary_search(discontinuities_.begin(), discontinuities_.end(), begin);
      if (const double before = std::nextafter(begin, -kNever); jumps && before > begins_[piece - 1])
        breakpoints_.push_back(before);
      breakpoints_.push_back(begin);
    }
    load_piece(piece);
    flow_->go(piece_, 0.0);
    double t = begin, step = kTurn / flow_->rate(piece_);
    while (breakpoints_.size() < kMostBreakpoints && end - t > 1.2 * step) {
      t += step;
      breakpoints_.push_back(t);
      if (flow_->largest_decay() == 0.0) continue;
      flow_->go(piece_, t - begin);
      step = kTurn / flow_->rate(piece_);
    }
  }
}

std::span<const double> PiecewiseMotion::breakpoints(const time::State& from, const time::State& to, time::Detail) {
  recall(from, to);
  if (!has_breakpoints_) find_breakpoints();
  return breakpoints_;
}

void PiecewiseMotion::interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                                  time::Interpolated out) {
  interpolate_all(from, to, {&t, 1}, dofs, out);
}

void PiecewiseMotion::interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                                      std::span<const Index> dofs, time::Interpolated out) {
  recall(from, to);
  std::size_t place = 0;
  for (const double t : times) {
    const bool is_end = t == from.t || t == to.t;
    const time::State& end = t == from.t ? from : to;
    if (!is_end) go_to(t);
    for (const Index dof : dofs) {
      const Jet jet = is_end ? Jet{end.x[dof], end.v[dof], end.a[dof], 0.0} : motion_of(dof);
      if (!out.x.empty()) out.x[place] = jet[0];
      if (!out.v.empty()) out.v[place] = jet[1];
      if (!out.a.empty()) out.a[place] = jet[2];
      ++place;
    }
  }
}

void PiecewiseMotion::departure(const time::State& from, const time::State& to, double begin, double end,
                                std::span<const Index> dofs, time::Interpolated out) {
  recall(from, to);
  go_to(begin);
  const double h = end - begin;
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    const QuinticError error = quintic_error(h, flow_->sixth_derivative(piece_, dofs[k], h));
    if (!out.x.empty()) out.x[k] = error.x;
    if (!out.v.empty()) out.v[k] = error.v;
    if (!out.a.empty()) out.a[k] = error.a;
  }
}

}  // namespace butee::integrators

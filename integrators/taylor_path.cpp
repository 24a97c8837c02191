#include "integrators/taylor_path.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/quintic.hpp"

namespace butee::integrators {

using time::State;
using time::StepStatus;

TaylorPath::TaylorPath(dynamics::Dynamics& dynamics, int order, double series_tolerance)
    : dynamics_(dynamics),
      expander_(dynamics, order, series_tolerance),
      branches_(dynamics.stops(), order),
      discontinuities_(dynamics.load_discontinuities()),
      stops_(dynamics.stop_count()) {}

double TaylorPath::first_length(const State& state, double length) {
  x_ = state.x;
  v_ = state.v;
  used_ = 0;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  place_branches();
  if (!expand_piece(state.t, length)) return length;
  const double reach = pieces_.front().reach * pieces_.front().length;
  return reach < std::numeric_limits<double>::max() ? reach : length;
}

void TaylorPath::place_branches() {
  dynamics_.stops().displacement(x_, stops_);
  branches_.place(stops_);
}

StepStatus TaylorPath::follow(const State& from, const time::Step& step) {
  const double h = step.h;
  // Phases of obstacles are those of a whole step, which ends where one of them changes.
  const bool is_single = step.single || dynamics_.obstacles() != nullptr;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  x_ = begin_x_ = from.x;
  v_ = begin_v_ = from.v;
  begin_t_ = from.t;
  used_ = 0;
  breakpoints_.clear();
  place_branches();
  double t = from.t, done = 0.0, length = h;
  while (done < h) {
    if (used_ == kMostPieces || !expand_piece(t, length)) return StepStatus::not_finite;
    TaylorExpansion& piece = pieces_[used_ - 1];
    const double rest = (h - done) / piece.length, jump = (next_discontinuity(t) - t) / piece.length;
    piece.end = std::min({piece.reach, rest, jump});
    const bool is_last = piece.end == rest;
    const auto change = branches_.first_change(expander_.stop_displacement(), piece.end);
    if (change) piece.end = change->at;
    length = piece.length * std::min(piece.reach, 1e3);
    for (Index i = 0; i < x_.size(); ++i) {
      const double x = piece.value(i, piece.end);
      v_[i] = piece.velocity(i, piece.end);
      x_[i] = x;
    }
    end_t_ = step.t_end;
    if (!change && is_last) break;
    done += piece.end * piece.length;
    t = from.t + done;
    if (is_single && t > from.t && t < step.t_end) {
      end_t_ = t;
      break;
    }
    if (t > (breakpoints_.empty() ? from.t : breakpoints_.back()) && t < step.t_end) breakpoints_.push_back(t);
    if (change) {
      branches_.apply(*change);
    } else {
      place_branches();
    }
  }
  return StepStatus::ok;
}

bool TaylorPath::expand_piece(double t, double length) {
  if (used_ == pieces_.size()) pieces_.emplace_back();
  TaylorExpansion& piece = pieces_[used_++];
  piece.length = length;
  for (int trial = 0; trial < kMostTrials; ++trial, piece.length *= 1e-3)
    if (expander_.expand(t, x_, v_, branches_, piece)) return true;
  return false;
}

double TaylorPath::next_discontinuity(double t) const {
  const auto next = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), t);
  return next == discontinuities_.end() ? std::numeric_limits<double>::infinity() : *next;
}

bool TaylorPath::holds(const State& from, double t_end) const {
  return from.t == begin_t_ && t_end == end_t_ && from.x == begin_x_ && from.v == begin_v_;
}

void TaylorPath::recall(const State& from, const State& to) {
  if (!holds(from, to.t)) follow(from, {to.t - from.t, to.t});
}

const TaylorExpansion& TaylorPath::piece_at(double t) const {
  std::size_t i = 0;
  while (i + 1 < used_ && pieces_[i + 1].begin <= t) ++i;
  return pieces_[i];
}

std::span<const double> TaylorPath::breakpoints(const State& from, const State& to, time::Detail) {
  recall(from, to);
  return breakpoints_;
}

void TaylorPath::interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                             time::Interpolated out) {
  recall(from, to);
  const TaylorExpansion& piece = piece_at(t);
  const double s = std::min((t - piece.begin) / piece.length, piece.end);
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    if (!out.x.empty()) out.x[k] = piece.value(dofs[k], s);
    if (!out.v.empty()) out.v[k] = piece.velocity(dofs[k], s);
    if (!out.a.empty()) out.a[k] = piece.acceleration(dofs[k], s);
  }
}

void TaylorPath::departure(const State& from, const State& to, double begin, double end, std::span<const Index> dofs,
                           time::Interpolated out) {
  recall(from, to);
  const TaylorExpansion& piece = piece_at(begin);
  const double s = std::min((end - piece.begin) / piece.length, piece.end), h = (end - begin) / piece.length;
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    // A bound of the sixth derivative with respect to s.
    double sixth = 0.0, power = 1.0;
    for (Index j = 6; j < piece.x.cols(); ++j, power *= s) {
      const auto n = static_cast<double>(j);
      sixth += n * (n - 1.0) * (n - 2.0) * (n - 3.0) * (n - 4.0) * (n - 5.0) * std::abs(piece.x(dofs[k], j)) * power;
    }
    const QuinticError error = quintic_error(h, sixth);
    if (!out.x.empty()) out.x[k] = error.x;
    if (!out.v.empty()) out.v[k] = error.v / piece.length;
    if (!out.a.empty()) out.a[k] = error.a / (piece.length * piece.length);
  }
}

}  // namespace butee::integrators

#include "integrators/exact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/config/diagnostics.hpp"
#include "integrators/methods.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

using time::State;
using time::StepReport;
using time::StepStatus;

namespace {

constexpr const char* kSeriesTolerance = "series_tolerance";
/// Of a scene that other methods run as well.
constexpr const char* kTolerance = "tolerance";

/// So many changes of contact within one step are no motion of a structure.
constexpr std::size_t kMostPieces = 20000;
/// Lengths are shortened a thousandfold this often before a step is given up.
constexpr int kMostTrials = 12;

/// 1/omega of the stiffest DOF with its stops closed, s; 1 s where nothing has a stiffness.
double natural_time(dynamics::Dynamics& dynamics) {
  Vector stiffness = dynamics.system().stiffness.diagonal();
  const dynamics::Contact& contact = dynamics.contact();
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)})
      if (dof >= 0) stiffness[dof] += closed[i];
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i)
      for (const auto& ends : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : {ends[0], ends[1]})
          if (dof >= 0) stiffness[dof] += obstacles->closed_stiffness(i);
  const double square = stiffness.cwiseQuotient(dynamics.system().mass.diagonal()).maxCoeff();
  return square > 0.0 && std::isfinite(square) ? 1.0 / std::sqrt(square) : 1.0;
}

}  // namespace

time::StepDecision Exact::Controller::decide(double, const StepReport& report) const {
  return {true, report.error};
}

Exact::Exact(dynamics::Dynamics& dynamics, int order, double series_tolerance)
    : Integrator(dynamics),
      expander_(dynamics, order, series_tolerance),
      branches_(dynamics.contact(), order),
      discontinuities_(dynamics.load_discontinuities()),
      first_length_(natural_time(dynamics)),
      stops_(dynamics.stop_count()) {}

void Exact::do_start(State& state) {
  x_ = state.x;
  v_ = state.v;
  used_ = 0;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  place_branches();
  first_step_ = first_length_;
  if (!expand_piece(state.t, first_length_)) return;
  const double reach = pieces_.front().reach * pieces_.front().length;
  if (reach < std::numeric_limits<double>::max()) first_step_ = reach;
}

void Exact::place_branches() {
  dynamics().contact().displacement(x_, stops_);
  branches_.place(stops_);
}

StepReport Exact::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report;
  report.status = follow(from, step);
  if (report.status != StepStatus::ok) return report;
  const TaylorExpansion& last = pieces_[used_ - 1];
  for (Index i = 0; i < to.x.size(); ++i) {
    to.x[i] = last.value(i, last.end);
    to.v[i] = last.velocity(i, last.end);
    to.a[i] = last.acceleration(i, last.end);
  }
  to.t = end_t_;
  report.error = last.reach * last.length;
  return report;
}

StepStatus Exact::follow(const State& from, const time::Step& step) {
  const double h = step.h;
  // Phases of obstacles are those of a whole step, which ends where one of them changes.
  const bool is_single = step.single || dynamics().obstacles() != nullptr;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  x_ = begin_x_ = from.x;
  v_ = begin_v_ = from.v;
  begin_t_ = from.t;
  used_ = 0;
  knots_.clear();
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
    if (t > (knots_.empty() ? from.t : knots_.back()) && t < step.t_end) knots_.push_back(t);
    if (change) {
      branches_.apply(*change);
    } else {
      place_branches();
    }
  }
  return StepStatus::ok;
}

bool Exact::expand_piece(double t, double length) {
  if (used_ == pieces_.size()) pieces_.emplace_back();
  TaylorExpansion& piece = pieces_[used_++];
  piece.length = length;
  for (int trial = 0; trial < kMostTrials; ++trial, piece.length *= 1e-3)
    if (expander_.expand(t, x_, v_, branches_, piece)) return true;
  return false;
}

double Exact::next_discontinuity(double t) const {
  const auto next = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), t);
  return next == discontinuities_.end() ? std::numeric_limits<double>::infinity() : *next;
}

bool Exact::holds(const State& from, double t_end) const {
  return from.t == begin_t_ && t_end == end_t_ && from.x == begin_x_ && from.v == begin_v_;
}

void Exact::recall(const State& from, const State& to) const {
  // Recomputing the pieces of a step that is no longer the last changes nothing that anyone could see.
  if (!holds(from, to.t)) const_cast<Exact*>(this)->follow(from, {to.t - from.t, to.t});
}

const TaylorExpansion& Exact::piece_at(double t) const {
  std::size_t i = 0;
  while (i + 1 < used_ && pieces_[i + 1].begin <= t) ++i;
  return pieces_[i];
}

std::span<const double> Exact::breakpoints(const State& from, const State& to) const {
  recall(from, to);
  return knots_;
}

void Exact::do_interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                           time::Interpolated out) const {
  recall(from, to);
  const TaylorExpansion& piece = piece_at(t);
  const double s = std::min((t - piece.begin) / piece.length, piece.end);
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    if (!out.x.empty()) out.x[k] = piece.value(dofs[k], s);
    if (!out.v.empty()) out.v[k] = piece.velocity(dofs[k], s);
    if (!out.a.empty()) out.a[k] = piece.acceleration(dofs[k], s);
  }
}

void Exact::departure(const State& from, const State& to, double begin, double end, std::span<const Index> dofs,
                      time::Interpolated out) const {
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

time::IntegratorType exact_type() {
  return {
      .name = "exact",
      .aliases = {"taylor"},
      .summary = "Taylor series with every change of contact located; no truncation error above rounding",
      .parameters = {config::integer("order", "the order of the series")
                         .at_least(4)
                         .at_most(60)
                         .or_else(std::int64_t{Exact::kOrder}),
                     config::number(kSeriesTolerance, "1", "size of the last terms of a series relative to the largest")
                         .above(0)
                         .at_most(0.1)
                         .or_else(Exact::kSeriesTolerance)
                         .sweep(1e-4, Exact::kSeriesTolerance),
                     config::number(kTolerance, "1", "ignored: truncation stays below rounding").above(0).optional()},
      .finds_first_step = true,
      .contacts = time::ContactSupport::all,
      .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        return std::make_unique<Exact>(dynamics, static_cast<int>(p.integer("order")), p.number(kSeriesTolerance));
      },
      .check =
          [](const config::Parameters& p, config::Diagnostics& diagnostics) {
            if (p.has(kTolerance))
              diagnostics.warning(
                  p.key(kTolerance), p.value(kTolerance).at,
                  "is ignored by exact, whose truncation stays below rounding; its own key is series_tolerance");
          }};
}

}  // namespace butee::integrators

#include "integrators/exponential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"
#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

using Eigen::ArrayXd;
using solve::ModalFlow;
using solve::StepFlow;
using time::State;
using time::StepReport;
using time::StepStatus;

/// Steps in a block; its knots stay in the cache.
constexpr int kBlock = 32;
/// What the state carries behind q and v: the rung of the ladder, the scale of errors, and whether the last step was
/// without stops within reach.
constexpr Index kExtras = 3;
/// Rungs that a step without stops within reach may be above those with.
constexpr int kQuietRungs = 2;
/// A step that would do with less than this part of its tolerance is followed by one a rung longer, whose error is four
/// times that; the rest is reserve against going back and forth.
constexpr double kGrow = 0.1;
/// The iteration ends where the path changes by less than this part of the tolerance, or by rounding.
constexpr double kConverged = 0.02;
constexpr double kRounding = 1e-15;
/// Passes; where they do not suffice the step is too long for the stiffness of the stops.
constexpr int kMostPasses = 25;
/// Below this part of the first step no step is worth trying.
constexpr int kMostRungsDown = 80;
/// The bump functions of cubic Hermite interpolation are at most 4/27.
constexpr double kBump = 4.0 / 27.0;
/// A step between outputs is rounded to so many digits, so that equal intervals are equal.
constexpr double kSameDigits = 1e10;

double rounded(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h))) / kSameDigits;
  return std::round(h / unit) * unit;
}

/// The displacement in the middle of a step may depart from the cubic by this part of the scale. At order 4 that is
/// what the error is made of; at order 2 the error is of a lower power of h. At order 6, which takes the departure into
/// the path, the error falls a little faster than it where stops open and close, and with its power 3/2 elsewhere.
/// Calibrated on beams and oscillators: tests/models/exponential_test.cpp.
double middle_tolerance(const ExponentialOptions& options) {
  switch (options.order) {
    case 2:
      return 0.1 * std::pow(options.tolerance, 1.5);
    case 4:
      return 0.03 * options.tolerance;
    default:
      return 0.08 * std::pow(options.tolerance, 0.8);
  }
}

}  // namespace

Exponential::Exponential(solve::Dynamics& dynamics, const ExponentialOptions& options)
    : Integrator(dynamics),
      options_(options),
      modal_(dynamics.modal(options.modes)),
      kinks_(dynamics.load_kinks()),
      tolerance_(middle_tolerance(options)) {
  solve::Contact& contact = dynamics.contact();
  gaps_.resize(contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    stops_.emplace_back(contact, i);
    gaps_[i] = contact.gap_of(i);
    has_far_forces_ = has_far_forces_ || contact.law_of(i).far_force() > 0.0;
  }
  first_level_ = find_first_level();
  for (ArrayXd* array : {&q_, &v_, &q_new_, &v_new_, &q_half_, &sums_[0], &sums_[1], &sums_[2]})
    array->setZero(modal_.size());
  for (ArrayXd* array : {&w_, &wv_, &w_new_, &wv_new_, &reach_}) array->setZero(contact.size());
  stop_force_.setZero(contact.size());
  far_forces_.setZero(contact.size());
  active_.reserve(static_cast<std::size_t>(contact.size()));
  far_.reserve(static_cast<std::size_t>(contact.size()));
  times_.reserve(kBlock + 1);
  for (Eigen::MatrixXd* matrix : {&knot_q_, &knot_v_, &knot_a_}) matrix->setZero(modal_.size(), kBlock + 1);
  has_acceleration_.assign(kBlock + 1, false);
}

int Exponential::find_first_level() const {
  if (stops_.empty()) return 0;
  const Vector stiffness = dynamics().contact().closed_stiffness();
  double square = 0.0;
  for (Index i = 0; i < modal_.stop_count(); ++i)
    square = std::max(square, stiffness[i] * modal_.stop_shapes().col(i).squaredNorm());
  const double h = std::pow(options_.tolerance, options_.order == 2 ? 0.5 : 0.25) * 4.0 / std::sqrt(square);
  return static_cast<int>(std::floor(2.0 * std::log2(std::min(h, 1.0 / std::sqrt(square)))));
}

double Exponential::first_step(const State&) const {
  return stops_.empty() ? std::numeric_limits<double>::infinity()
                        : kBlock * solve::ModalSystem::ladder_step(first_level_);
}

void Exponential::do_start(State& state) {
  const Index n = modal_.size();
  state.memory.resize(2 * n + kExtras);
  modal_.to_modal(state.x, state.memory.head(n));
  modal_.to_modal(state.v, state.memory.segment(n, n));
  double scale = 0.0;
  if (!stops_.empty()) {
    modal_.stop_displacement(state.memory.data(), w_.data());
    scale = w_.abs().maxCoeff();
  }
  state.memory.tail(kExtras) << static_cast<double>(first_level_), scale, 0.0;
  if (modal_.is_complete()) return;
  Vector kept(state.x.size());
  for (const Vector* given : {&state.x, &state.v}) {
    modal_.to_physical(state.memory.data() + (given == &state.v ? n : 0), kept);
    if ((kept - *given).norm() > options_.tolerance * given->norm())
      throw InputError("integrator.modes: " + std::to_string(n) +
                       " modes do not hold the initial displacements and velocities to the tolerance; take more modes");
  }
}

StepReport Exponential::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report = follow(from, step);
  if (report.status != StepStatus::ok) return report;
  const Index n = modal_.size();
  to.t = times_.back();
  to.memory.head(n) = q_;
  to.memory.segment(n, n) = v_;
  to.memory.tail(kExtras) << static_cast<double>(level_), scale_, active_.empty() ? 1.0 : 0.0;
  modal_.to_physical(q_.data(), to.x);
  modal_.to_physical(v_.data(), to.v);
  dynamics().acceleration(to.t, to.x, to.v, to.a);
  report.error =
      stops_.empty() ? std::numeric_limits<double>::infinity() : kBlock * solve::ModalSystem::ladder_step(level_);
  return report;
}

StepReport Exponential::follow(const State& from, const time::Step& step) {
  using solve::ModalSystem;
  const Index n = modal_.size();
  begin_t_ = from.t;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  begin_memory_ = from.memory;
  q_ = from.memory.head(n).array();
  v_ = from.memory.segment(n, n).array();
  level_ = static_cast<int>(from.memory[2 * n]);
  scale_ = from.memory[2 * n + 1];
  bool is_quiet = from.memory[2 * n + 2] != 0.0;
  if (!stops_.empty()) {
    modal_.stop_displacement(q_.data(), w_.data());
    modal_.stop_displacement(v_.data(), wv_.data());
  }
  times_.assign(1, from.t);
  course_knot_ = kNone;
  const int lowest = first_level_ - kMostRungsDown;
  StepReport report;
  report.inner_steps = 0;
  const int most = step.single ? 1 : kBlock;
  while (report.inner_steps < most) {
    const auto knot = static_cast<Index>(times_.size()) - 1;
    knot_q_.col(knot) = q_;
    knot_v_.col(knot) = v_;
    has_acceleration_[times_.size() - 1] = false;
    note_phases(times_.back());
    const double t = times_.back(), rest = times_.size() == 1 ? step.h : step.t_end - t, kink = next_kink(t) - t;
    Trial trial = Trial::too_long;
    double end = step.t_end;
    bool is_on_ladder = false;
    for (int rungs = level_ + (is_quiet ? kQuietRungs : 0); trial == Trial::too_long;) {
      const double h = stops_.empty() ? std::numeric_limits<double>::infinity() : ModalSystem::ladder_step(rungs);
      const bool fits = h <= std::min(rest, kink);
      if (!fits && kink >= rest && report.inner_steps > 0) break;
      StepFlow& flow = fits ? modal_.ladder(rungs)
                            : modal_.odd(stops_.empty() ? rounded(std::min(rest, kink)) : std::min(rest, kink));
      end = fits ? t + h : kink < rest ? t + kink : step.t_end;
      is_quiet = is_quiet && fits;
      is_on_ladder = fits;
      trial = try_step(flow, t);
      if (trial == Trial::accepted) break;
      if (trial == Trial::not_finite || rungs <= lowest) {
        report.status = StepStatus::not_finite;
        return report;
      }
      ++report.inner_rejected;
      if (is_quiet && rungs > level_) {
        rungs = level_;  // A stop came within reach.
      } else {
        rungs = fits ? rungs - 1 : static_cast<int>(std::ceil(2.0 * std::log2(flow.h()))) - 1;
        level_ = std::min(level_, rungs);
      }
      is_quiet = false;
    }
    if (trial != Trial::accepted) break;
    q_.swap(q_new_);
    v_.swap(v_new_);
    w_.swap(w_new_);
    wv_.swap(wv_new_);
    times_.push_back(end);
    ++report.inner_steps;
    is_quiet = active_.empty();
    if (!is_quiet && is_on_ladder && error_ < kGrow * tolerance_ * scale_) ++level_;
    if (end >= step.t_end) break;
  }
  const auto knot = static_cast<Index>(times_.size()) - 1;
  knot_q_.col(knot) = q_;
  knot_v_.col(knot) = v_;
  has_acceleration_[times_.size() - 1] = false;
  end_t_ = times_.back();
  return report;
}

void Exponential::note_phases(double t) {
  phases_.clear();
  for (const solve::ModalHarmonic& harmonic : modal_.harmonics()) {
    const double angle = harmonic.angular_frequency * t;
    phases_.push_back({std::cos(angle), std::sin(angle)});
  }
}

void Exponential::propagate(const ModalFlow& flow, double t, bool with_speed, ArrayXd& q, ArrayXd& v) const {
  q = flow.qq() * q_ + flow.qv() * v_;
  if (with_speed) v = flow.vq() * q_ + flow.vv() * v_;
  for (std::size_t j = 0; j < flow.angular_frequencies().size(); ++j) {
    const auto [c, s] = phases_[j];
    q += c * flow.harmonic_q(j, 0) - s * flow.harmonic_q(j, 1);
    if (with_speed) v += c * flow.harmonic_v(j, 0) - s * flow.harmonic_v(j, 1);
  }
  for (const solve::ModalSystem::OtherLoad& load : modal_.other_loads()) {
    const double h = flow.h(), f0 = load.in_time->value(t), f1 = load.in_time->value(t + 0.5 * h),
                 f2 = load.in_time->value(t + h);
    // The parabola through three values, in P_0, P_1 and P_2.
    const double p0 = (f0 + 4.0 * f1 + f2) / 6.0, p1 = 0.5 * (f2 - f0), p2 = (f0 - 2.0 * f1 + f2) / 3.0;
    q += load.shape * (p0 * flow.force_q(0) + p1 * flow.force_q(1) + p2 * flow.force_q(2));
    if (with_speed) v += load.shape * (p0 * flow.force_v(0) + p1 * flow.force_v(1) + p2 * flow.force_v(2));
  }
}

Exponential::Trial Exponential::try_step(StepFlow& flow, double t) {
  propagate(flow.whole, t, true, q_new_, v_new_);
  active_.clear();
  error_ = 0.0;
  if (stops_.empty()) return q_new_.allFinite() && v_new_.allFinite() ? Trial::accepted : Trial::not_finite;
  modal_.stop_displacement(q_new_.data(), w_new_.data());
  modal_.stop_displacement(v_new_.data(), wv_new_.data());
  if (!std::isfinite(w_new_.sum() + wv_new_.sum())) return Trial::not_finite;
  find_active(flow, t);
  if (has_far_forces_) add_far_forces(flow);
  if (!active_.empty()) {
    const Trial trial = iterate(flow);
    if (trial != Trial::accepted) return trial;
    apply_forces(flow);
  }
  scale_ = std::max(scale_, w_new_.abs().maxCoeff());
  return Trial::accepted;
}

void Exponential::find_active(const StepFlow& flow, double t) {
  const double h = flow.h();
  // How far modes too fast for a cubic can carry a stop away from it.
  const double swing = (flow.swing_q * q_.abs()).sum() + (flow.swing_v * v_.abs()).sum();
  reach_ = w_.abs().max(w_new_.abs()) + kBump * h * (wv_.abs() + wv_new_.abs()) + swing;
  far_.clear();
  bool has_half = false;
  for (Index i = 0; i < w_.size(); ++i) {
    if (reach_[i] <= gaps_[i]) {
      if (has_far_forces_) far_.push_back(i);
      continue;
    }
    if (!has_half) propagate(flow.half, t, false, q_half_, q_half_);
    has_half = true;
    Active active{};
    active.stop = i;
    active.w0 = w_[i];
    active.hv0 = h * wv_[i];
    active_.push_back(active);
  }
}

void Exponential::add_far_forces(const StepFlow& flow) {
  if (far_.empty()) return;
  const double h = flow.h();
  ArrayXd& sum = sums_[0];
  far_forces_.setZero();
  for (const Index i : far_) {
    const StopPath path(w_[i], h * wv_[i], w_new_[i], h * wv_new_[i], 0.0);
    far_forces_[i] = stops_[static_cast<std::size_t>(i)].far_force(path);
  }
  sum.matrix().noalias() = modal_.stop_shapes() * far_forces_;
  q_new_ += sum * flow.whole.force_q(0);
  v_new_ += sum * flow.whole.force_v(0);
  if (!active_.empty()) q_half_ += sum * flow.half.force_q(0);
  modal_.stop_displacement(q_new_.data(), w_new_.data());
  modal_.stop_displacement(v_new_.data(), wv_new_.data());
}

Exponential::Trial Exponential::iterate(StepFlow& flow) {
  const double h = flow.h();
  const auto orders = static_cast<std::size_t>(options_.order / 2);
  for (Active& a : active_) {
    a.w1 = w_new_[a.stop];
    a.hv1 = h * wv_new_[a.stop];
    a.middle = q_half_.matrix().dot(modal_.stop_shapes().col(a.stop));
    a.force = {};
  }
  const bool uses_bulge = orders == 3;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double change = sweep(flow, orders, uses_bulge);
    if (!std::isfinite(change)) return Trial::too_long;
    double scale = scale_;
    for (const Active& a : active_) scale = std::max(scale, std::abs(a.w1));
    if (change > std::max(kConverged * tolerance_, kRounding) * scale) continue;
    for (const Active& a : active_) {
      if (a.course == StopForce::Course::open && std::abs(a.bulge) + reach_[a.stop] <= gaps_[a.stop]) continue;
      double error = std::abs(a.bulge);
      if (orders == 1) error += std::abs(flow.coupling(a.stop, a.stop).end[1] * a.force[1]);
      error_ = std::max(error_, error);
    }
    return error_ <= tolerance_ * scale ? Trial::accepted : Trial::too_long;
  }
  return Trial::too_long;
}

double Exponential::sweep(StepFlow& flow, std::size_t orders, bool uses_bulge) {
  const double h = flow.h();
  double change = 0.0;
  for (Active& a : active_) {
    a.bulge = a.middle - (0.5 * (a.w0 + a.w1) + 0.125 * (a.hv0 - a.hv1));
    const StopPath path(a.w0, a.hv0, a.w1, a.hv1, uses_bulge ? a.bulge : 0.0);
    StopForce& stop = stops_[static_cast<std::size_t>(a.stop)];
    a.course = stop.course(path);
    const ForceMoments force = stop.moments(path, a.course);
    ForceMoments more{};
    for (std::size_t k = 0; k < orders; ++k) more[k] = force[k] - a.force[k];
    a.force = force;
    if (more[0] == 0.0 && more[1] == 0.0 && more[2] == 0.0) continue;
    for (Active& b : active_) {
      const StepFlow::Coupling& c = flow.coupling(b.stop, a.stop);
      const double w = c.end[0] * more[0] + c.end[1] * more[1] + c.end[2] * more[2],
                   hv = h * (c.speed[0] * more[0] + c.speed[1] * more[1] + c.speed[2] * more[2]),
                   middle = c.middle[0] * more[0] + c.middle[1] * more[1] + c.middle[2] * more[2];
      b.w1 += w;
      b.hv1 += hv;
      b.middle += middle;
      change = std::max(change, std::abs(w) + kBump * std::abs(hv) + std::abs(middle));
    }
  }
  return change;
}

void Exponential::apply_forces(const StepFlow& flow) {
  const int orders = options_.order / 2;
  bool any = false;
  for (int k = 0; k < orders; ++k) sums_[static_cast<std::size_t>(k)].setZero();
  for (const Active& a : active_) {
    if (a.force[0] == 0.0 && a.force[1] == 0.0 && a.force[2] == 0.0) continue;
    any = true;
    const auto shape = modal_.stop_shapes().col(a.stop).array();
    for (std::size_t k = 0; k < static_cast<std::size_t>(orders); ++k) sums_[k] += a.force[k] * shape;
  }
  if (!any) return;
  for (int k = 0; k < orders; ++k) {
    const ArrayXd& sum = sums_[static_cast<std::size_t>(k)];
    q_new_ += sum * flow.whole.force_q(k);
    v_new_ += sum * flow.whole.force_v(k);
  }
  modal_.stop_displacement(q_new_.data(), w_new_.data());
  modal_.stop_displacement(v_new_.data(), wv_new_.data());
}

double Exponential::next_kink(double t) const {
  const auto next = std::upper_bound(kinks_.begin(), kinks_.end(), t);
  return next == kinks_.end() ? std::numeric_limits<double>::infinity() : *next;
}

bool Exponential::holds(const State& from, double t_end) const {
  return from.t == begin_t_ && t_end == end_t_ && from.memory == begin_memory_;
}

std::span<const double> Exponential::knots(const State& from, const State& to) const {
  if (!holds(from, to.t) || times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

void Exponential::evaluate_exactly(std::size_t knot, double t, std::span<const Index> dofs, time::Interpolated out) {
  q_ = knot_q_.col(static_cast<Index>(knot)).array();
  v_ = knot_v_.col(static_cast<Index>(knot)).array();
  if (t > times_[knot]) {
    note_phases(times_[knot]);
    propagate(modal_.odd(rounded(t - times_[knot])).whole, times_[knot], true, q_new_, v_new_);
    q_.swap(q_new_);
    v_.swap(v_new_);
  }
  ArrayXd& a = sums_[0];
  a = -modal_.frequencies().square() * q_ - 2.0 * modal_.decay() * v_;
  modal_.add_load(t, a);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto shape = modal_.shape_rows().col(dofs[i]);
    if (!out.x.empty()) out.x[i] = shape.dot(q_.matrix());
    if (!out.v.empty()) out.v[i] = shape.dot(v_.matrix());
    if (!out.a.empty()) out.a[i] = shape.dot(a.matrix());
  }
}

void Exponential::complete_knot(std::size_t knot) {
  if (has_acceleration_[knot]) return;
  const auto k = static_cast<Index>(knot);
  auto a = knot_a_.col(k).array();
  a = -modal_.frequencies().square() * knot_q_.col(k).array() - 2.0 * modal_.decay() * knot_v_.col(k).array();
  modal_.add_load(times_[knot], a);
  if (!stops_.empty()) {
    modal_.stop_displacement(knot_q_.col(k).data(), w_new_.data());
    dynamics().contact().force(w_new_.matrix(), stop_force_);
    for (Index i = 0; i < stop_force_.size(); ++i)
      if (stop_force_[i] != 0.0) a += stop_force_[i] * modal_.stop_shapes().col(i).array();
  }
  has_acceleration_[knot] = true;
}

Motion Exponential::motion_at(std::size_t knot, Index dof) {
  complete_knot(knot);
  const auto k = static_cast<Index>(knot);
  const auto shape = modal_.shape_rows().col(dof);
  return {shape.dot(knot_q_.col(k)), shape.dot(knot_v_.col(k)), shape.dot(knot_a_.col(k))};
}

void Exponential::lay_courses(std::size_t knot, std::span<const Index> dofs) {
  // What was the end of the courses laid last is most often the beginning of these.
  const bool goes_on = course_knot_ != kNone && knot == course_knot_ + 1 && std::ranges::equal(dofs, course_dofs_);
  course_knot_ = knot;
  course_dofs_.assign(dofs.begin(), dofs.end());
  course_ends_.resize(dofs.size());
  courses_.clear();
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Motion begin = goes_on ? course_ends_[i] : motion_at(knot, dofs[i]);
    course_ends_[i] = motion_at(knot + 1, dofs[i]);
    courses_.emplace_back(times_[knot + 1] - times_[knot], begin, course_ends_[i]);
  }
}

void Exponential::do_interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                                 time::Interpolated out) const {
  // Recomputing a block that is no longer the last changes nothing that anyone could see.
  auto& self = const_cast<Exponential&>(*this);
  if (t == from.t || t == to.t) {
    const State& end = t == from.t ? from : to;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      if (!out.x.empty()) out.x[i] = end.x[dofs[i]];
      if (!out.v.empty()) out.v[i] = end.v[dofs[i]];
      if (!out.a.empty()) out.a[i] = end.a[dofs[i]];
    }
    return;
  }
  if (!holds(from, to.t)) self.follow(from, {to.t - from.t, to.t});
  std::size_t knot = course_knot_;
  if (knot == kNone || t < times_[knot] || t >= times_[knot + 1])
    knot = static_cast<std::size_t>(std::upper_bound(times_.begin() + 1, times_.end() - 1, t) - times_.begin()) - 1;
  if (stops_.empty()) return self.evaluate_exactly(knot, t, dofs, out);
  if (knot != course_knot_ || !std::ranges::equal(dofs, course_dofs_)) self.lay_courses(knot, dofs);
  const double s = (t - times_[knot]) / (times_[knot + 1] - times_[knot]);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Quintic& course = courses_[i];
    if (!out.x.empty()) out.x[i] = course.value(s);
    if (!out.v.empty()) out.v[i] = course.slope(s);
    if (!out.a.empty()) out.a[i] = course.curvature(s);
  }
}

time::IntegratorType exponential_type() {
  return {"exponential",
          {"EXP"},
          "the linear part exactly, mode by mode; the stops by the projection of their force; adaptive",
          {config::number("tolerance", "1", "relative error aimed at, of the largest displacement of a stop so far")
               .above(0)
               .at_most(0.1)
               .or_else(1e-4)
               .sweep(1e-1, 1e-9),
           config::integer("order", "2, 4 or 6").at_least(2).at_most(6).or_else(std::int64_t{6}),
           config::integer("modes", "the lowest modes to take; 0: all up to 600 DOFs, 300 above")
               .at_least(0)
               .or_else(std::int64_t{0})},
          kUnconditional,
          [](const config::Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Exponential>(
                dynamics, ExponentialOptions{p.number("tolerance"), static_cast<int>(p.integer("order")),
                                             static_cast<Index>(p.integer("modes"))});
          },
          [](const config::Parameters& p, config::Diagnostics& diagnostics) {
            if (p.integer("order") % 2 != 0) p.complain(diagnostics, "order", "must be 2, 4 or 6");
          },
          false,
          true};
}

}  // namespace butee::integrators

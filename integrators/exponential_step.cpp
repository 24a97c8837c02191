#include "integrators/exponential_step.hpp"

#include <algorithm>
#include <cmath>

#include "butee/solve/dynamics.hpp"

namespace butee::integrators {
namespace {

using Eigen::ArrayXd;
using solve::ModalFlow;
using solve::StepFlow;

/// A step that would do with less than this part of its tolerance is followed by one a rung longer, whose error is four
/// times that; the rest is reserve against going back and forth.
constexpr double kEasy = 0.1;
/// The iteration ends where the path changes by less than this part of the tolerance, or by rounding.
constexpr double kConverged = 0.02;
constexpr double kRounding = 1e-15;
/// Sweeps; where they do not suffice the step is too long for the stiffness of the stops.
constexpr int kMostSweeps = 25;
/// Nearer to a stop than so many widths of the bend of its law, the force is more than a constant pull.
constexpr double kBends = 10.0, kHuge = 1e100;
/// The bump functions of cubic Hermite interpolation are at most 4/27.
constexpr double kBump = 4.0 / 27.0;

}  // namespace

ExponentialStep::ExponentialStep(solve::Dynamics& dynamics, solve::ModalSystem& modal, int order, double tolerance)
    : modal_(modal), orders_(static_cast<std::size_t>(order / 2)), tolerance_(tolerance) {
  solve::Contact& contact = dynamics.contact();
  gaps_.resize(contact.size());
  borders_.resize(contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    stops_.emplace_back(contact, i);
    gaps_[i] = contact.gap_of(i);
    borders_[i] = gaps_[i] - kBends * std::min(contact.law_of(i).bend_width(), kHuge);
    has_far_forces_ = has_far_forces_ || contact.law_of(i).far_force() > 0.0;
  }
  for (ArrayXd* array : {&q_, &v_, &q_new_, &v_new_, &q_half_, &sums_[0], &sums_[1], &sums_[2]})
    array->setZero(modal_.size());
  for (ArrayXd* array : {&w_, &wv_, &w_new_, &wv_new_, &reach_}) array->setZero(contact.size());
  far_forces_.setZero(contact.size());
  active_.reserve(stops_.size());
  far_.reserve(stops_.size());
  phases_.reserve(modal_.harmonics().size());
}

void ExponentialStep::begin(const double* q, const double* v, double scale) {
  q_ = Eigen::Map<const ArrayXd>(q, modal_.size());
  v_ = Eigen::Map<const ArrayXd>(v, modal_.size());
  scale_ = scale;
  if (!has_stops()) return;
  modal_.stop_displacement(q_.data(), w_.data());
  modal_.stop_displacement(v_.data(), wv_.data());
}

void ExponentialStep::accept() {
  q_.swap(q_new_);
  v_.swap(v_new_);
  w_.swap(w_new_);
  wv_.swap(wv_new_);
}

bool ExponentialStep::is_easy() const {
  return error_ < kEasy * tolerance_ * scale_;
}

void ExponentialStep::follow(const ModalFlow& flow, double t) {
  note_phases(t);
  propagate(flow, t, true, q_new_, v_new_);
  q_.swap(q_new_);
  v_.swap(v_new_);
}

void ExponentialStep::note_phases(double t) {
  phases_.clear();
  for (const solve::ModalHarmonic& harmonic : modal_.harmonics()) {
    const double angle = harmonic.angular_frequency * t;
    phases_.push_back({std::cos(angle), std::sin(angle)});
  }
}

void ExponentialStep::propagate(const ModalFlow& flow, double t, bool with_speed, ArrayXd& q, ArrayXd& v) const {
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

ExponentialStep::Trial ExponentialStep::attempt(StepFlow& flow, double t) {
  note_phases(t);
  propagate(flow.whole, t, true, q_new_, v_new_);
  active_.clear();
  error_ = 0.0;
  if (!has_stops()) return q_new_.allFinite() && v_new_.allFinite() ? Trial::accepted : Trial::not_finite;
  find_stops();
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

void ExponentialStep::find_stops() {
  modal_.stop_displacement(q_new_.data(), w_new_.data());
  modal_.stop_displacement(v_new_.data(), wv_new_.data());
}

void ExponentialStep::find_active(const StepFlow& flow, double t) {
  const double h = flow.h();
  // How far modes and loads too fast for a cubic can carry a stop away from it.
  double swing = (flow.swing_q * q_.abs()).sum() + (flow.swing_v * v_.abs()).sum() + flow.swing_harmonics;
  for (const solve::ModalSystem::OtherLoad& load : modal_.other_loads())
    swing += std::max(std::abs(load.in_time->value(t)), std::abs(load.in_time->value(t + h))) *
             (flow.swing_force * load.shape.abs()).sum();
  reach_ = w_.abs().max(w_new_.abs()) + kBump * h * (wv_.abs() + wv_new_.abs()) + swing;
  far_.clear();
  bool has_half = false;
  for (Index i = 0; i < w_.size(); ++i) {
    if (reach_[i] <= borders_[i]) {
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

void ExponentialStep::add_far_forces(const StepFlow& flow) {
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
  find_stops();
}

ExponentialStep::Trial ExponentialStep::iterate(StepFlow& flow) {
  const double h = flow.h();
  for (Active& a : active_) {
    a.w1 = w_new_[a.stop];
    a.hv1 = h * wv_new_[a.stop];
    a.middle = q_half_.matrix().dot(modal_.stop_shapes().col(a.stop));
    a.force = {};
  }
  for (int i = 0; i < kMostSweeps; ++i) {
    const double change = sweep(flow);
    if (!std::isfinite(change)) return Trial::too_long;
    double scale = scale_;
    for (const Active& a : active_) scale = std::max(scale, std::abs(a.w1));
    if (change > std::max(kConverged * tolerance_, kRounding) * scale) continue;
    find_error(flow);
    return error_ <= tolerance_ * scale ? Trial::accepted : Trial::too_long;
  }
  return Trial::too_long;
}

void ExponentialStep::find_error(StepFlow& flow) {
  for (const Active& a : active_) {
    if (a.course == StopForce::Course::open && std::abs(a.bulge) + reach_[a.stop] <= borders_[a.stop]) continue;
    double error = std::abs(a.bulge);
    if (orders_ == 1) error += std::abs(flow.coupling(a.stop, a.stop).end[1] * a.force[1]);
    error_ = std::max(error_, error);
  }
}

double ExponentialStep::sweep(StepFlow& flow) {
  const double h = flow.h();
  double change = 0.0;
  for (Active& a : active_) {
    a.bulge = a.middle - (0.5 * (a.w0 + a.w1) + 0.125 * (a.hv0 - a.hv1));
    const StopPath path(a.w0, a.hv0, a.w1, a.hv1, orders_ == 3 ? a.bulge : 0.0);
    StopForce& stop = stops_[static_cast<std::size_t>(a.stop)];
    a.course = stop.course(path);
    const ForceMoments force = stop.moments(path, a.course);
    ForceMoments more{};
    for (std::size_t k = 0; k < orders_; ++k) more[k] = force[k] - a.force[k];
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

void ExponentialStep::apply_forces(const StepFlow& flow) {
  bool any = false;
  for (std::size_t k = 0; k < orders_; ++k) sums_[k].setZero();
  for (const Active& a : active_) {
    if (a.force[0] == 0.0 && a.force[1] == 0.0 && a.force[2] == 0.0) continue;
    any = true;
    const auto shape = modal_.stop_shapes().col(a.stop).array();
    for (std::size_t k = 0; k < orders_; ++k) sums_[k] += a.force[k] * shape;
  }
  if (!any) return;
  for (std::size_t k = 0; k < orders_; ++k) {
    q_new_ += sums_[k] * flow.whole.force_q(static_cast<int>(k));
    v_new_ += sums_[k] * flow.whole.force_v(static_cast<int>(k));
  }
  find_stops();
}

}  // namespace butee::integrators

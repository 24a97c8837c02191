#include "integrators/exponential_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {
namespace {

using dynamics::ModalFlow;
using dynamics::StepFlow;
using Eigen::ArrayXd;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// A step is this part of the time or longer where the middle of a step is used: rounding then moves it by 1e-9 of h.
constexpr double kShortest = 2e-7;
/// Added to the distance of a side on which a stop does not act, m.
constexpr double kNever = 1e100;

}  // namespace

ExponentialStep::ExponentialStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, int order,
                                 const StepGoal& goal, std::size_t most)
    : modal_(modal),
      orders_(static_cast<std::size_t>(order / 2)),
      goal_(goal),
      tolerance_(goal.middle),
      output_tolerance_(goal.outputs),
      contact_(dynamics.contact()),
      squares_(modal.frequencies().square()),
      is_strongly_damped_((4.0 * modal.decay() > modal.frequencies()).any()),
      knots_(dynamics, modal, stops_, 2 * most),
      energy_(dynamics, modal),
      longest_near_(longest_near_stops(modal)) {
  const dynamics::Contact& contact = contact_;
  const Index padded = StepFlow::padded(contact.size());
  for (ArrayXd* array : {&q_, &v_, &q_new_, &v_new_, &q_half_, &v_half_, &sums_[0], &sums_[1], &sums_[2],
                         &jump_sums_[0], &jump_sums_[1], &jump_sums_[2]})
    array->setZero(modal_.size());
  for (ArrayXd* array : {&w_,           &wv_,    &w_new_,    &wv_new_,     &largest_w_,   &largest_wv_, &reach_,
                         &a_,           &hv_,    &path_.end, &path_.speed, &path_.middle, &seen_.end,   &seen_.speed,
                         &seen_.middle, &bulge_, &excess_,   &force_[0],   &force_[1],    &force_[2]})
    array->setZero(padded);
  gaps_.setConstant(padded, kInfinite);
  borders_ = gaps_;
  off_upper_.setZero(padded);
  off_lower_.setZero(padded);
  upper_ = gaps_;
  lower_ = -gaps_;
  for (Index i = 0; i < contact.size(); ++i) {
    stops_.emplace_back(contact_, i);
    own_.emplace_back(stops_.back().stiffness(), orders_);
    gaps_[i] = contact.gap_of(i);
    borders_[i] = calm_border(contact, i);
    pulls_.emplace_back(contact, i);
    if (contact.sides_of(i) != model::Sides::negative)
      upper_[i] = gaps_[i];
    else
      off_upper_[i] = kNever;
    if (contact.sides_of(i) != model::Sides::positive)
      lower_[i] = -gaps_[i];
    else
      off_lower_[i] = kNever;
    has_far_forces_ = has_far_forces_ || contact.law_of(i).far_force() > 0.0;
  }
  for (Index i = 0; i < contact.size(); ++i) {
    pair_of_.push_back(-1);
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a < 0 || b < 0) continue;
    pair_of_.back() = static_cast<Index>(pairs_.size());
    const auto shape = modal_.stop_shapes().of(i);
    const auto share_of = [&](Index dof) {
      return std::abs(modal_.shape_rows().col(dof).dot(shape)) / shape.squaredNorm();
    };
    pairs_.push_back({i, modal_.shape_rows().col(a), share_of(a), share_of(b)});
  }
  pair_scales_.resize(pairs_.size());
  pull_sizes_.setZero(padded);
  shares_.setOnes(padded);
  bends_.setZero(padded);
  for (Index i = 0; i < contact.size() && has_far_forces_; ++i) {
    pull_sizes_[i] = contact.law_of(i).far_force();
    bends_[i] = contact.law_of(i).bend_width();
  }
  is_steady_.setConstant(padded, false);
  for (std::vector<Index>* list : {&reachable_, &touched_, &far_, &jumping_}) list->reserve(stops_.size());
  is_touched_.assign(stops_.size(), false);
  pull_.setZero(contact.size());
  stop_forces_.setZero(contact.size());
  pull_sum_.setZero(modal_.size());
}

void ExponentialStep::complete(double* memory) const {
  const Index n = modal_.size();
  if (!has_stops()) return;
  const Index m = modal_.stop_count();
  double* stops = memory + 2 * n;
  modal_.stop_shapes().displacement(memory, memory + n, stops, stops + m);
  Eigen::Map<ArrayXd>(stops + 2 * m, 2 * m) = Eigen::Map<const ArrayXd>(stops, 2 * m).abs();
  double* to = stops + 4 * m;
  for (const Pair& pair : pairs_) {
    const double x = pair.shape_a.dot(Eigen::Map<const Vector>(memory, n)),
                 v = pair.shape_a.dot(Eigen::Map<const Vector>(memory + n, n));
    for (const double value : {x, x - stops[pair.stop], v, v - stops[m + pair.stop]}) *to++ = std::abs(value);
  }
}

void ExponentialStep::raise_pairs() {
  for (std::size_t j = 0; j < pairs_.size(); ++j) {
    const Pair& pair = pairs_[j];
    PairScale& scale = pair_scales_[j];
    const double x = pair.shape_a.dot(q_.matrix()), v = pair.shape_a.dot(v_.matrix());
    scale.x_a = std::max(scale.x_a, std::abs(x));
    scale.x_b = std::max(scale.x_b, std::abs(x - w_[pair.stop]));
    scale.v_a = std::max(scale.v_a, std::abs(v));
    scale.v_b = std::max(scale.v_b, std::abs(v - wv_[pair.stop]));
  }
}

void ExponentialStep::begin(double t, const double* memory, StopScale scale) {
  const Index n = modal_.size(), m = modal_.stop_count();
  q_ = Eigen::Map<const ArrayXd>(memory, n);
  v_ = Eigen::Map<const ArrayXd>(memory + n, n);
  w_.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n, m);
  wv_.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n + m, m);
  largest_w_.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n + 2 * m, m);
  largest_wv_.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n + 3 * m, m);
  const double* from = memory + 2 * n + 4 * m;
  for (PairScale& of : pair_scales_) {
    of = {from[0], from[1], from[2], from[3]};
    from += 4;
  }
  scale_ = scale;
  if (has_far_forces_)
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      const auto stop = static_cast<Index>(i);
      const double impulse = kLasting * goal_.tolerance / modal_.stop_shapes().of(stop).squaredNorm();
      stops_[i].allow(impulse * scale.speed / goal_.run_time, impulse * scale.speed / scale.own_time());
    }
  knots_.begin(t, q_.data(), v_.data(), w_.data());
  modal_bounds_.knot = static_cast<std::size_t>(-1);
  pull_.setZero();
  pull_sum_.setZero();
}

void ExponentialStep::save(double* memory) const {
  const Index n = modal_.size(), m = modal_.stop_count();
  Eigen::Map<ArrayXd>(memory, n) = q_;
  Eigen::Map<ArrayXd>(memory + n, n) = v_;
  Eigen::Map<ArrayXd>(memory + 2 * n, m) = w_.head(m);
  Eigen::Map<ArrayXd>(memory + 2 * n + m, m) = wv_.head(m);
  Eigen::Map<ArrayXd>(memory + 2 * n + 2 * m, m) = largest_w_.head(m);
  Eigen::Map<ArrayXd>(memory + 2 * n + 3 * m, m) = largest_wv_.head(m);
  double* to = memory + 2 * n + 4 * m;
  for (const PairScale& scale : pair_scales_)
    for (const double value : {scale.x_a, scale.x_b, scale.v_a, scale.v_b}) *to++ = value;
}

void ExponentialStep::accept(double t) {
  record_forces(knots_.steps());
  if (middle_knot_ > 0.0) knots_.add(middle_knot_, q_half_.data(), v_half_.data(), path_.middle.data());
  q_.swap(q_new_);
  v_.swap(v_new_);
  w_.swap(w_new_);
  wv_.swap(wv_new_);
  largest_w_ = largest_w_.max(w_.abs());
  largest_wv_ = largest_wv_.max(wv_.abs());
  raise_pairs();
  knots_.add(t, q_.data(), v_.data(), w_.data());
}

void ExponentialStep::record_forces(std::size_t knot) {
  StepForces& forces = knots_.forces(knot);
  const bool has_contact = !reachable_.empty() && !touched_.empty();
  forces.is_free = !has_contact && !has_far_forces_;
  forces.touched.clear();
  if (has_contact) {
    forces.touched = touched_;
    forces.paths.col(StepForces::kStartSpeed) = hv_;
    forces.paths.col(StepForces::kEndSpeed) = path_.speed;
    if (orders_ == 3) forces.paths.col(StepForces::kBulge) = bulge_;
    for (std::size_t k = 0; k < 3; ++k) forces.paths.col(StepForces::kMoments + static_cast<Index>(k)) = force_[k];
  }
  const auto felt_speed = [&](Index i) {
    const StopScale reached = {std::abs(w_new_[i]), std::max(std::abs(wv_[i]), std::abs(wv_new_[i]))};
    return output_tolerance_ * scale_of(i, reached, scale_.displacement).speed;
  };
  for (const Index i : forces.touched) forces.paths(i, StepForces::kFeltSpeed) = felt_speed(i);
  for (std::size_t j = 0; j < jumping_.size(); ++j) {
    const Index i = jumping_[j];
    forces.touched.push_back(i);
    forces.paths(i, StepForces::kStartSpeed) = tried_h_ * wv_[i];
    forces.paths(i, StepForces::kEndSpeed) = tried_h_ * wv_new_[i];
    forces.paths(i, StepForces::kBulge) = 0.0;
    forces.paths(i, StepForces::kFeltSpeed) = felt_speed(i);
    for (std::size_t k = 0; k < 3; ++k) forces.paths(i, StepForces::kMoments + static_cast<Index>(k)) = jumps_[j][k];
  }
  if (has_far_forces_) forces.standing = pull_;
  for (std::size_t k = 0; k < (forces.is_free ? 0 : forces.moments.size()); ++k) {
    auto to = forces.moments[k].head(modal_.size()).array();
    if (has_contact && k < orders_)
      to = sums_[k];
    else
      to.setZero();
    if (!jumping_.empty()) to += jump_sums_[k];
    if (k == 0 && has_far_forces_) to += pull_sum_;
  }
  // Only steps without contact have a knot in the middle.
  if (middle_knot_ > 0.0) forces.divide(0.5, knots_.forces(knot + 1));
}

void ExponentialStep::propagate(const ModalFlow& flow, std::size_t knot, double t_end, ArrayXd& q, ArrayXd* v) {
  const std::span<const Phase> phases = knots_.phases(knot);
  const double t = knots_.time(knot);
  const Eigen::Map<const ArrayXd> q0(knots_.q(knot), modal_.size()), v0(knots_.v(knot), modal_.size());
  q = flow.qq() * q0 + flow.qv() * v0;
  if (v != nullptr) *v = flow.vq() * q0 + flow.vv() * v0;
  if (has_far_forces_) {
    q += pull_sum_ * flow.force_q(0);
    if (v != nullptr) *v += pull_sum_ * flow.force_v(0);
  }
  for (std::size_t j = 0; j < phases.size(); ++j) {
    const auto [c, s] = phases[j];
    q += c * flow.harmonic_q(j, 0) - s * flow.harmonic_q(j, 1);
    if (v != nullptr) *v += c * flow.harmonic_v(j, 0) - s * flow.harmonic_v(j, 1);
  }
  for (const dynamics::ModalSystem::OtherLoad& load : modal_.other_loads()) {
    // The middle of a step near the rounding of the time is not where it should be; a load is straight there.
    const double f0 = load.in_time->value(t), f2 = load.in_time->value(t_end),
                 f1 = t_end - t < kShortest * t_end ? 0.5 * (f0 + f2) : load.in_time->value(0.5 * (t + t_end));
    // The parabola through three values, in P_0, P_1 and P_2.
    const double p0 = (f0 + 4.0 * f1 + f2) / 6.0, p1 = 0.5 * (f2 - f0), p2 = (f0 - 2.0 * f1 + f2) / 3.0;
    q += load.shape * (p0 * flow.force_q(0) + p1 * flow.force_q(1) + p2 * flow.force_q(2));
    if (v != nullptr) *v += load.shape * (p0 * flow.force_v(0) + p1 * flow.force_v(1) + p2 * flow.force_v(2));
  }
}

Trial ExponentialStep::attempt(StepFlow& flow, double t_end) {
  tried_h_ = flow.h();
  end_ = t_end;
  propagate(flow.whole, knots_.steps(), end_, q_new_, &v_new_);
  reachable_.clear();
  is_near_ = false;
  error_ = middle_knot_ = 0.0;
  if (!has_stops()) return q_new_.allFinite() && v_new_.allFinite() ? Trial::accepted : Trial::not_finite;
  find_stops();
  if (!std::isfinite(w_new_.sum() + wv_new_.sum())) return Trial::not_finite;
  reached_ = {std::max(scale_.displacement, w_new_.abs().maxCoeff()), std::max(scale_.speed, wv_new_.abs().maxCoeff())};
  if (has_far_forces_) find_shares();
  find_reachable(flow);
  if (has_far_forces_)
    while (place_pull(flow) && add_reachable(flow)) {
    }
  if (is_near_ && flow.h() > longest_near_) return Trial::too_long;
  if (!reachable_.empty()) propagate(flow.half, knots_.steps(), 0.5 * (knots_.last() + end_), q_half_, nullptr);
  if (is_quiet() && !is_smooth(flow)) return Trial::too_long;
  if (has_far_forces_) add_jumps(flow);
  if (middle_knot_ > 0.0 && shows_jump(flow.h())) return Trial::too_long;
  if (!reachable_.empty()) {
    const Trial trial = iterate(flow);
    if (trial != Trial::accepted) return trial;
    apply_forces(flow);
  }
  if (has_far_forces_ && middle_knot_ > 0.0) modal_.stop_shapes().displacement(q_half_.data(), path_.middle.data());
  scale_.displacement = std::max(scale_.displacement, w_new_.abs().maxCoeff());
  scale_.speed = std::max(scale_.speed, wv_new_.abs().maxCoeff());
  return Trial::accepted;
}

void ExponentialStep::expect_motion(int level) {
  const ModalFlow& flow = modal_.ladder(level).whole;
  propagate(flow, knots_.steps(), knots_.last() + flow.h(), q_new_, &v_new_);
  find_stops();
  if (!std::isfinite(w_new_.sum() + wv_new_.sum())) return;
  scale_.displacement = std::max(scale_.displacement, w_new_.abs().maxCoeff());
  scale_.speed = std::max(scale_.speed, wv_new_.abs().maxCoeff());
}

void ExponentialStep::find_stops() {
  modal_.stop_shapes().displacement(q_new_.data(), v_new_.data(), w_new_.data(), wv_new_.data());
}

void ExponentialStep::find_reachable(StepFlow& flow) {
  // How far modes and loads too fast for a cubic can carry a stop away from it.
  load_swing_ = flow.swing_harmonics;
  const double t = knots_.last();
  for (const dynamics::ModalSystem::OtherLoad& load : modal_.other_loads())
    load_swing_ += std::max(std::abs(load.in_time->value(t)), std::abs(load.in_time->value(t + flow.h()))) *
                   (flow.swing_force * load.shape.abs()).sum();
  swing_ = (flow.swing_q * q_.abs() + flow.swing_v * v_.abs()).sum() + load_swing_;
  find_reach(flow.h());
  far_.clear();
  if (has_far_forces_) find_steady(flow);
  for (Index i = 0; i < static_cast<Index>(stops_.size()); ++i) {
    is_near_ = is_near_ || is_near(i);
    if (is_near(i) || (has_far_forces_ && !is_steady_[i] && !is_steady(flow, i)))
      reachable_.push_back(i);
    else if (has_far_forces_)
      far_.push_back(i);
  }
}

void ExponentialStep::find_reach(double h) {
  // A stop on one side is near on that side alone.
  reach_ = (w_.max(w_new_) - off_upper_).max(-w_.min(w_new_) - off_lower_) + (kBump * h) * (wv_.abs() + wv_new_.abs()) +
           swing_;
}

bool ExponentialStep::add_reachable(StepFlow& flow) {
  const std::size_t before = reachable_.size();
  reached_.displacement = std::max(reached_.displacement, w_new_.abs().maxCoeff());
  find_shares();
  find_reach(flow.h());
  for (const Index i : far_) {
    is_near_ = is_near_ || is_near(i);
    if (is_near(i) || !is_steady(flow, i)) reachable_.push_back(i);
  }
  if (reachable_.size() == before) return false;
  std::sort(reachable_.begin(), reachable_.end());
  std::erase_if(far_, [&](Index i) { return std::binary_search(reachable_.begin(), reachable_.end(), i); });
  return true;
}

bool ExponentialStep::shows_jump(double h) const {
  const auto shows = [&](Index i) {
    if (w_[i] * w_new_[i] > 0.0) return false;
    const double jump = 2.0 * pulls_[static_cast<std::size_t>(i)].largest();
    return ModalKnots::kJump * h * modal_.stop_shapes().of(i).squaredNorm() * jump > output_tolerance_ * reached_.speed;
  };
  return std::any_of(reachable_.begin(), reachable_.end(), shows) ||
         std::any_of(jumping_.begin(), jumping_.end(), shows);
}

void ExponentialStep::apply_forces(StepFlow& flow) {
  for (std::size_t k = orders_; k < force_.size(); ++k) force_[k].setZero();  // Those were for the estimate alone.
  flow.add_forces(touched_, force_, far_registers_, path_);
  w_new_ = path_.end;
  wv_new_ = path_.speed * (1.0 / flow.h());
  if (touched_.empty()) return;
  const ModalFlow& whole = flow.whole;
  for (std::size_t k = 0; k < orders_; ++k) modal_.stop_shapes().force(touched_, force_[k].data(), sums_[k].data());
  if (orders_ == 3) {
    q_new_ += sums_[0] * whole.force_q(0) + sums_[1] * whole.force_q(1) + sums_[2] * whole.force_q(2);
    v_new_ += sums_[0] * whole.force_v(0) + sums_[1] * whole.force_v(1) + sums_[2] * whole.force_v(2);
  } else {
    for (std::size_t k = 0; k < orders_; ++k) {
      q_new_ += sums_[k] * whole.force_q(static_cast<int>(k));
      v_new_ += sums_[k] * whole.force_v(static_cast<int>(k));
    }
  }
  for (std::size_t k = 0; k < (middle_knot_ > 0.0 ? orders_ : 0); ++k) add_to_half(flow.half, k);
}

}  // namespace butee::integrators

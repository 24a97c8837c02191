#include "integrators/contact_on_the_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {
namespace {

/// Penetrations below this fraction of the displacement are rounding errors.
constexpr double kRounding = 1e-13;

/// The force of a regularised law bends up to this multiple of its transition width, where that of the arctan law is
/// within 2 % of its asymptotic force.
constexpr double kBendWidths = 4.0;
/// A step that stays beyond the bend resolves the force there if its distance to the border changes by less than this
/// factor.
constexpr double kTailRatio = 4.0;
/// A step that covers more than this part of the distance from its nearest penetration to the poles of the law is fast.
constexpr double kFast = 0.3;

/// Upper bound of a motion through (w0, v0) and (w1, v1), a step of h apart, that rises at the
/// start and falls at the end: the peak of the cubic plus its error. The error is estimated from
/// the difference between the cubic's acceleration at the start and the true one, a0.
double peak(double h, double w0, double v0, double a0, double w1, double v1) {
  // dw/ds = h v0 + 2 b s + 3 c s^2
  const double rise = w1 - w0, b = 3.0 * rise - h * (2.0 * v0 + v1), c = h * (v0 + v1) - 2.0 * rise;
  const double root = std::sqrt(std::max(0.0, b * b - 3.0 * c * h * v0));
  const double s = std::clamp(h * v0 / (root - b), 0.0, 1.0);
  // The error of the cubic is the fourth derivative times h^4/384 in the middle, that of its
  // acceleration at an end the fourth derivative times h^2/12.
  const double error = std::abs(2.0 * b - h * h * a0) / 32.0;
  return w0 + s * (h * v0 + s * (b + s * c)) + error;
}

}  // namespace

double inner_border(const model::ContactLaw& law) {
  const double width = law.transition_width();
  return law.is_silent_while_open() && std::isfinite(width) ? width : 0.0;
}

ContactOnTheWay::ContactOnTheWay(dynamics::Dynamics& dynamics, double tolerance)
    : contact_(&dynamics.stops()), tolerance_(tolerance) {
  w0_ = w1_ = v0_ = v1_ = a0_ = least_ = most_ = strayed_ = Vector::Zero(contact_->size());
  jumps_ = bends_ = residual_ = w0_;
  closed_ = contact_->closed_stiffness();
  mass_ = dynamics.system().mass.diagonal();
  for (Index i = 0; i < contact_->size(); ++i) {
    const double gap = contact_->play_of(i).gap, width = contact_->law_of(i).transition_width();
    if (std::isfinite(width)) {
      bends_[i] = kBendWidths * width;
      residual_[i] = contact_->law_of(i).asymptotic_force();
    }
    if (contact_->play_of(i).has_both()) jumps_[i] = 2.0 * std::abs(contact_->law_of(i).secant(-gap)) * gap;
  }
}

void ContactOnTheWay::begin(const time::State& from) {
  if (contact_->size() == 0) return;
  has_strayed_ = false;
  contact_->displacement(from.x, w0_);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < w0_.size(); ++i) {
    const model::FreePlay& play = contact_->play_of(i);
    const double side = play.closed_side(w0_[i]);
    least_[i] = side > 0.0 ? play.gap : side < 0.0 ? -kFar : play.lower();
    most_[i] = side > 0.0 ? kFar : side < 0.0 ? -play.gap : play.upper();
  }
}

void ContactOnTheWay::look(ConstVectorRef x) {
  if (contact_->size() == 0) return;
  contact_->displacement(x, w0_);
  const auto outside = w0_.array() < least_.array() || w0_.array() > most_.array();
  if (!outside.any()) return;
  if (!has_strayed_) strayed_.setZero();
  has_strayed_ = true;
  strayed_ = outside.select(1.0, strayed_);
}

double ContactOnTheWay::impulse_rate(Index stop, ConstVectorRef scale_v) const {
  double rate = 0.0;
  for (const Index dof : {contact_->dof_a(stop), contact_->dof_b(stop)})
    if (dof >= 0 && scale_v[dof] > 0.0) rate = std::max(rate, 1.0 / (mass_[dof] * scale_v[dof]));
  return rate;
}

bool ContactOnTheWay::is_noticeable(Index stop, double jump, double h, ConstVectorRef scale_v) const {
  return jump > 0.0 && jump * h * impulse_rate(stop, scale_v) > kNegligibleImpulse * tolerance_;
}

ContactOnTheWay::Bend ContactOnTheWay::bend(Index stop, double h) const {
  const double bend = bends_[stop];
  if (bend == 0.0) return {};
  const double w0 = w0_[stop], w1 = w1_[stop], v0 = v0_[stop], v1 = v1_[stop];
  const double turn = v0 * v1 < 0.0 ? w0 + 0.5 * h * v0 * v0 / (v0 - v1) : w0;
  const model::FreePlay& play = contact_->play_of(stop);
  const auto [low, high] = std::minmax({play.penetration(w0), play.penetration(w1), play.penetration(turn)});
  const auto [near, far] = std::minmax({std::abs(low), std::abs(high)});
  const double range = high - low, nearest = low * high > 0.0 ? near : 0.0, width = bend / kBendWidths;
  Bend found;
  found.is_fast = range * range > kFast * kFast * (nearest * nearest + width * width);
  if (low < bend && high > -bend) {
    if (range > bend) found.force = residual_[stop];
  } else if (far >= kTailRatio * near) {
    found.force = std::abs(std::abs(contact_->law_of(stop).secant(-near)) * near - residual_[stop]);
  }
  return found;
}

bool ContactOnTheWay::changed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v) {
  is_fast_at_bend_ = false;
  if (contact_->size() == 0) return false;
  if (has_strayed_) return true;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  contact_->displacement(from.v, v0_);
  contact_->displacement(to.v, v1_);
  for (Index i = 0; i < w0_.size(); ++i) {
    const model::FreePlay& play = contact_->play_of(i);
    if (play.closed_side(w0_[i]) != play.closed_side(w1_[i])) return true;
    if (has_passed_middle(i) && is_noticeable(i, jumps_[i], h, scale_v)) return true;
    const Bend on_the_way = bend(i, h);
    if (is_noticeable(i, on_the_way.force, h, scale_v)) return true;
    is_fast_at_bend_ = is_fast_at_bend_ || (on_the_way.is_fast && is_noticeable(i, residual_[i], h, scale_v));
  }
  return false;
}

double ContactOnTheWay::jump(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v) {
  double largest = 0.0;
  if (!(residual_.array() > 0.0).any()) return largest;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  contact_->displacement(from.v, v0_);
  contact_->displacement(to.v, v1_);
  for (Index i = 0; i < w0_.size(); ++i) {
    if (has_passed_middle(i)) largest = std::max(largest, jumps_[i] * impulse_rate(i, scale_v));
    largest = std::max(largest, bend(i, h).force * impulse_rate(i, scale_v));
  }
  return largest;
}

double ContactOnTheWay::kink(const time::State& from, const time::State& to, ConstVectorRef scale_v) {
  double largest = 0.0;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  contact_->displacement(from.v, v0_);
  contact_->displacement(to.v, v1_);
  for (Index i = 0; i < w0_.size(); ++i) {
    const model::FreePlay& play = contact_->play_of(i);
    const bool has_strayed = has_strayed_ && strayed_[i] != 0.0;
    if (!has_strayed && play.closed_side(w0_[i]) == play.closed_side(w1_[i])) continue;
    largest = std::max(largest, closed_[i] * std::max(std::abs(v0_[i]), std::abs(v1_[i])) * impulse_rate(i, scale_v));
  }
  return largest;
}

double ContactOnTheWay::longest_of_impact(const time::State& from, double h, ConstVectorRef scale_v) {
  double longest = std::numeric_limits<double>::infinity();
  if (contact_->size() == 0) return longest;
  contact_->displacement(from.x, w0_);
  contact_->displacement(from.v, v0_);
  for (Index i = 0; i < w0_.size(); ++i) {
    const model::FreePlay& play = contact_->play_of(i);
    const double side = play.closed_side(w0_[i]), speed = side * v0_[i];
    if (!(speed > 0.0) || side * w0_[i] - play.gap > kJustClosed * h * speed) continue;
    for (const Index dof : {contact_->dof_a(i), contact_->dof_b(i)})
      if (dof >= 0 && std::abs(from.v[dof]) > tolerance_ * scale_v[dof])
        longest = std::min(longest, kMostTurn * std::sqrt(mass_[dof] / closed_[i]));
  }
  return longest;
}

bool ContactOnTheWay::was_missed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v) {
  if (contact_->size() == 0) return false;
  contact_->displacement(from.v, v0_);
  contact_->displacement(to.v, v1_);
  // Only a motion that reverses can enter a stop and leave it again.
  if (!((v0_.array() * v1_.array()) < 0.0).any()) return false;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  contact_->displacement(from.a, a0_);
  for (Index i = 0; i < w0_.size(); ++i) {
    const double side = v0_[i] > 0.0 ? 1.0 : -1.0;
    if (!(side * v0_[i] > 0.0 && side * v1_[i] < 0.0)) continue;
    const model::FreePlay& play = contact_->play_of(i);
    const double gap = play.gap, w0 = side * w0_[i], w1 = side * w1_[i];
    const double size = std::max({gap, std::abs(w0), std::abs(w1)});
    const auto depth_beyond = [&](double border) {
      // On the border itself a stop is open.
      if (w0 > border || w1 > border) return 0.0;
      return peak(h, w0, side * v0_[i], side * a0_[i], w1, side * v1_[i]) - border;
    };
    const auto has_impulse = [&](double depth) {
      return depth > kRounding * size &&
             closed_[i] * depth * h * impulse_rate(i, scale_v) > kNegligibleImpulse * tolerance_;
    };
    if (play.has_side(-side) && has_impulse(depth_beyond(-gap))) return true;
    if (!play.has_side(side)) continue;
    const double depth = depth_beyond(gap);
    if (depth > tolerance_ * size || has_impulse(depth)) return true;
    // Beyond the middle the force pulls away from it, however small the depth.
    if (is_noticeable(i, jumps_[i], h, scale_v) && depth_beyond(0.0) > kRounding * size) return true;
  }
  return false;
}

}  // namespace butee::integrators

#include "integrators/contact_on_the_way.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

/// A jump of the force by so much of what closes the gap, over the tolerance, moves nothing by the tolerance.
constexpr double kUnfelt = 0.05;

/// The largest value of the cubic through (w0, v0) and (w1, v1), a step of h apart, that rises at first and falls at
/// last.
double peak(double h, double w0, double v0, double w1, double v1) {
  // dw/ds = h v0 + 2 b s + 3 c s^2
  const double rise = w1 - w0, b = 3.0 * rise - h * (2.0 * v0 + v1), c = h * (v0 + v1) - 2.0 * rise;
  const double root = std::sqrt(std::max(0.0, b * b - 3.0 * c * h * v0));
  const double s = std::clamp(h * v0 / (root - b), 0.0, 1.0);
  return w0 + s * (h * v0 + s * (b + s * c));
}

}  // namespace

ContactOnTheWay::ContactOnTheWay(solve::Dynamics& dynamics, double tolerance)
    : contact_(&dynamics.contact()), tolerance_(tolerance) {
  w0_ = w1_ = v0_ = v1_ = Vector::Zero(contact_->size());
  const Vector closed = contact_->closed_stiffness();
  for (Index i = 0; i < contact_->size(); ++i) {
    const double gap = contact_->gap_of(i), force = std::abs(contact_->law_of(i).secant(-gap)) * gap;
    jumps_.push_back(contact_->sides_of(i) == model::Sides::both && force > kUnfelt * tolerance * closed[i] * gap);
  }
}

bool ContactOnTheWay::changed(const time::State& from, const time::State& to) {
  if (contact_->size() == 0) return false;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  const auto closed_on = [&](Index i, double w) {
    const model::Sides sides = contact_->sides_of(i);
    const double gap = contact_->gap_of(i);
    if (w > gap) return sides == model::Sides::negative ? 0 : 1;
    if (w < -gap) return sides == model::Sides::positive ? 0 : -1;
    return 0;
  };
  for (Index i = 0; i < w0_.size(); ++i)
    if (closed_on(i, w0_[i]) != closed_on(i, w1_[i]) ||
        (jumps_[static_cast<std::size_t>(i)] && std::signbit(w0_[i]) != std::signbit(w1_[i])))
      return true;
  return false;
}

bool ContactOnTheWay::was_missed(const time::State& from, const time::State& to, double h) {
  if (contact_->size() == 0) return false;
  contact_->displacement(from.v, v0_);
  contact_->displacement(to.v, v1_);
  // Only where a motion turns can it go into a stop and come out again.
  if (!((v0_.array() * v1_.array()) < 0.0).any()) return false;
  contact_->displacement(from.x, w0_);
  contact_->displacement(to.x, w1_);
  for (Index i = 0; i < w0_.size(); ++i) {
    const double side = v0_[i] > 0.0 ? 1.0 : -1.0;
    if (!(side * v0_[i] > 0.0 && side * v1_[i] < 0.0)) continue;
    const model::Sides sides = contact_->sides_of(i);
    if (sides != model::Sides::both && (sides == model::Sides::positive) != (side > 0.0)) continue;
    const double gap = contact_->gap_of(i), w0 = side * w0_[i], w1 = side * w1_[i];
    if (w0 >= gap || w1 >= gap) continue;
    const double depth = peak(h, w0, side * v0_[i], w1, side * v1_[i]) - gap;
    if (depth > tolerance_ * std::max({gap, std::abs(w0), std::abs(w1)})) return true;
  }
  return false;
}

}  // namespace butee::integrators

#include "butee/record/slip_watch.hpp"

#include <algorithm>

#include "butee/core/text.hpp"

namespace butee::record {

namespace {

/// Some methods refuse smaller ones.
constexpr double kSmallestTolerance = 1e-10;

}  // namespace

SlipWatch::SlipWatch(dynamics::Dynamics& dynamics) : obstacles_(*dynamics.obstacles()) {
  for (Index i = 0; i < obstacles_.size(); ++i)
    if (obstacles_.group_of(i).friction.slip_speed > 0.0) contacts_.push_back(i);
  largest_.assign(contacts_.size(), 0.0);
}

void SlipWatch::start(const time::State& state) {
  std::fill(largest_.begin(), largest_.end(), 0.0);
  take(state);
}

void SlipWatch::take(const time::State& state) {
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    largest_[i] = std::max(largest_[i], obstacles_.gather(contacts_[i], state.v).head<2>().norm());
}

std::string SlipWatch::complaint(double tolerance) const {
  std::size_t worst = contacts_.size();
  double most = 1.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const double unresolved = tolerance * largest_[i] / obstacles_.group_of(contacts_[i]).friction.slip_speed;
    if (unresolved > most) most = unresolved, worst = i;
  }
  if (worst == contacts_.size()) return "";
  const model::ObstacleGroup& group = obstacles_.group_of(contacts_[worst]);
  const double slip_speed = group.friction.slip_speed, tighter = slip_speed / largest_[worst];
  using Kind = model::ContactShape::Form::Kind;
  // Friction supports slip along a line.
  const model::ContactShape::Form form = group.shape != nullptr ? group.shape->form() : model::ContactShape::Form();
  const Kind kind = group.shape == nullptr ? Kind::line : form.kind;
  const bool may_stick = kind == Kind::line || (kind == Kind::circle && form.distance != 0.0);
  std::string others = tighter >= kSmallestTolerance ? "tolerance = " + to_short_text(tighter) + " or less" : "";
  if (may_stick)
    others += std::string(others.empty() ? "" : ", or ") + "stick_stiffness" +
              (kind == Kind::line ? " or stick = \"rigid\"" : "") + ", which needs no slip_speed";
  return "the friction at " + obstacles_.name_of(contacts_[worst]) +
         " reverses within slip_speed = " + to_short_text(slip_speed) + " m/s, but for the tolerance " +
         to_short_text(tolerance) + " the error of the speed there, which reaches " + to_short_text(largest_[worst]) +
         " m/s, may be " + to_short_text(tolerance * largest_[worst]) +
         " m/s. Take slip_speed = " + to_short_text(tolerance * largest_[worst]) + " or more" +
         (others.empty() ? "" : ", or " + others);
}

}  // namespace butee::record

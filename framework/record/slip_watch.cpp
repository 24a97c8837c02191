#include "butee/record/slip_watch.hpp"

#include <algorithm>

#include "butee/core/text.hpp"

namespace butee::record {

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
  const double slip_speed = obstacles_.group_of(contacts_[worst]).friction.slip_speed;
  return "the friction at " + obstacles_.name_of(contacts_[worst]) +
         " reverses within slip_speed = " + to_short_text(slip_speed) + " m/s, but for the tolerance " +
         to_short_text(tolerance) + " the error of the speed there, which reaches " + to_short_text(largest_[worst]) +
         " m/s, may be " + to_short_text(tolerance * largest_[worst]) +
         " m/s. Take slip_speed = " + to_short_text(tolerance * largest_[worst]) +
         " or more, tolerance = " + to_short_text(slip_speed / largest_[worst]) +
         " or less, or stick_stiffness or stick = \"rigid\", which need no slip_speed";
}

}  // namespace butee::record

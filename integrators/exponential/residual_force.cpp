#include "integrators/exponential/residual_force.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

ResidualForce::ResidualForce(const dynamics::ElasticStops& contact, Index stop)
    : largest_(contact.law_of(stop).asymptotic_force()),
      bend_(contact.law_of(stop).transition_width()),
      gap_(contact.play_of(stop).gap),
      jumps_(contact.play_of(stop).has_both()) {}

double ResidualForce::constant_error(double w0, double w1, double bound, double compliance, double steps) const {
  // `varying` is the next term of the series of the arctan law about infinity.
  const double part = bend_ / (gap_ - bound), varying = part * part / 3.0 * steps * steps;
  const double shift = largest_ * compliance, on_the_way = std::abs(w1 - w0);
  const bool stays = (w0 > 0.0) == (w1 > 0.0) && std::min(std::abs(w0), std::abs(w1)) > shift;
  const double jump = !jumps_ || stays ? 0.0 : 2.0 * (shift < on_the_way ? shift / on_the_way : 1.0);
  return largest_ * compliance * (varying + jump * steps);
}

double constant_force_limit(const dynamics::ElasticStops& contact, Index stop) {
  constexpr double kBends = 10.0, kHuge = 1e100, kBlunt = 100.0;
  const model::ContactLaw& law = contact.law_of(stop);
  const double bend = std::min(law.transition_width(), kHuge), gap = contact.play_of(stop).gap;
  if (law.asymptotic_force() > 0.0 && gap < kBlunt * bend) return -kHuge;
  return gap - kBends * bend;
}

}  // namespace butee::integrators

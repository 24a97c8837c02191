#include "integrators/far_pull.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

FarPull::FarPull(const dynamics::Contact& contact, Index stop)
    : pull_(contact.law_of(stop).far_force()),
      bend_(contact.law_of(stop).bend_width()),
      gap_(contact.gap_of(stop)),
      jumps_(contact.sides_of(stop) == model::Sides::both) {}

double FarPull::unfelt(double w0, double w1, double reach, double mobility, double steps) const {
  // The next term of the arctan's series about infinity.
  const double part = bend_ / (gap_ - reach), varying = part * part / 3.0 * steps * steps;
  const double shift = pull_ * mobility, on_the_way = std::abs(w1 - w0);
  const bool stays = (w0 > 0.0) == (w1 > 0.0) && std::min(std::abs(w0), std::abs(w1)) > shift;
  const double jump = !jumps_ || stays ? 0.0 : 2.0 * (shift < on_the_way ? shift / on_the_way : 1.0);
  return pull_ * mobility * (varying + jump * steps);
}

double calm_border(const dynamics::Contact& contact, Index stop) {
  constexpr double kBends = 10.0, kHuge = 1e100, kBlunt = 100.0;
  const model::ContactLaw& law = contact.law_of(stop);
  const double bend = std::min(law.bend_width(), kHuge), gap = contact.gap_of(stop);
  if (law.far_force() > 0.0 && gap < kBlunt * bend) return -kHuge;
  return gap - kBends * bend;
}

}  // namespace butee::integrators

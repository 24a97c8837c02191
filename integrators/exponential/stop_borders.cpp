#include "integrators/exponential/stop_borders.hpp"

#include <cmath>
#include <utility>

#include "butee/core/error.hpp"
#include "integrators/contact_on_the_way.hpp"

namespace butee::integrators {
namespace {

/// The distance of the borders beside a transition from g = 0, in widths of the transition (chosen). The force of
/// `arctan` departs from its asymptote by 2 % of asymptotic_force() there.
constexpr double kBeside = 4.0;
/// A start is at a jump if its distance is below this fraction of the distance of the next node.
constexpr double kAtJump = 1e-3;

}  // namespace

StopBorders::StopBorders(dynamics::ElasticStops& stops) : stops_(stops) {
  for (Index i = 0; i < stops.size(); ++i) {
    const model::ContactLaw& law = stops.law_of(i);
    const model::FreePlay& play = stops.play_of(i);
    const bool is_silent = law.is_silent_while_open();
    if (!is_silent && !std::isfinite(law.transition_width()))
      throw InputError(
          "integrator.type: the law of a stop acts while the stop is open and does not give the width of its "
          "transition, which exponential requires for coupled modes");
    const double width = is_silent ? inner_border(law) : kBeside * law.transition_width();
    std::vector<double>& borders = borders_.emplace_back();
    for (const auto& [border, outwards] : {std::pair{play.upper(), 1.0}, std::pair{play.lower(), -1.0}}) {
      if (!std::isfinite(border)) continue;
      borders.push_back(border);
      if (width > 0.0) borders.push_back(border + outwards * width);
      if (width > 0.0 && !is_silent) borders.push_back(border - outwards * width);
    }
    if (is_silent || !play.has_both()) continue;
    borders.push_back(0.0);
    jumping_.push_back(i);
  }
}

double StopBorders::first_crossing(Index stop, const Row& displacement, CrossingRange range) const {
  for (const double border : borders_[static_cast<std::size_t>(stop)])
    range.last = StepNodes::first_crossing(displacement, border, range);
  return range.last;
}

double StopBorders::side_of_step(double start, double next) {
  const double w = std::abs(start) > kAtJump * std::abs(next) ? start : next;
  return w == 0.0 ? 0.0 : std::copysign(1.0, w);
}

double StopBorders::continuation(Index stop, double side, double w) const {
  if (side == 0.0 || side * w > 0.0) return 0.0;
  const double g = side * w - stops_.play_of(stop).gap;
  return -side * stops_.law_of(stop).secant(g) * g - stops_.force_of(stop, w);
}

}  // namespace butee::integrators

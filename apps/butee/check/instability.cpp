#include "instability.hpp"

#include <butee/dynamics/whirl.hpp>
#include <butee/model/rotation.hpp>

namespace butee::app::check {

std::optional<Instability> fastest_growth(const model::Model& model, const model::System& system, double end_time) {
  const bool may_grow = !system.stiffness_is_symmetric || system.circulatory.size() > 0 || system.dashpots.size() > 0;
  if (!may_grow || system.size() > kMostForInstability) return std::nullopt;
  const double speed = model.rotation ? model.rotation->largest_speed() : 0.0;
  std::optional<Instability> fastest;
  for (const dynamics::WhirlMode& mode : dynamics::Whirl(model).modes(speed, 2 * system.size()))
    if (const double rate = mode.lambda.real(); rate * end_time > 1.0 && (!fastest || rate > fastest->rate))
      fastest = {rate, mode.frequency(), speed};
  return fastest;
}

}  // namespace butee::app::check

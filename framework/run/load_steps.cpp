#include "butee/run/load_steps.hpp"

#include <limits>

#include "butee/core/text.hpp"

namespace butee::run {
namespace {

/// Instants closer than a step by this part of it are a step apart.
constexpr double kRoundingOfStep = 1e-6;

}  // namespace

std::string complaint_of_loads(const model::System& system, double time_step, double end_time) {
  double shortest = time_step * (1.0 - kRoundingOfStep);
  const model::FreeLoad* fastest = nullptr;
  for (const model::FreeLoad& load : system.loads) {
    double last = -std::numeric_limits<double>::infinity();
    for (const double t : load.in_time->discontinuities()) {
      if (t > last && last >= 0.0 && last < end_time && t - last < shortest) {
        shortest = t - last;
        fastest = &load;
      }
      last = t;
    }
  }
  if (fastest == nullptr) return "";
  const auto dof = static_cast<std::size_t>(fastest->dofs.front());
  return "the load on " + system.dofs.name(system.dofs.free()[dof]) + " changes within " + to_short_text(shortest) +
         " s, and steps of " + to_short_text(time_step) +
         " s see it only at their own instants. Take time_step = " + to_short_text(shortest) +
         " or a method with error control";
}

}  // namespace butee::run

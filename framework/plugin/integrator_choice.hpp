#pragma once

#include <optional>

#include "butee/plugin/catalogue.hpp"
#include "butee/time/simulation.hpp"

namespace butee::plugin {

/// What [integrator] of a scene asks for.
struct IntegratorChoice {
  std::string name;  ///< canonical
  time::SimulationOptions options;
  config::Parameters parameters;
};

/// Reads [integrator] with its tables for single methods: `type`, `time_step`, `end_time` and the method's parameters.
/// Keys directly in [integrator] win over those of [integrator.NAME]. Tables of methods that are not chosen are checked
/// as well. Nothing is returned where there was a mistake; all of them go to `diagnostics`. No module is loaded.
BUTEE_EXPORT std::optional<IntegratorChoice> read_integrator(const config::Value& root, const Catalogue& catalogue,
                                                             config::Diagnostics& diagnostics);

}  // namespace butee::plugin

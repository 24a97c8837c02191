#pragma once

#include <optional>

#include "butee/plugin/catalogue.hpp"
#include "butee/time/simulation.hpp"

namespace butee::scene {

/// What [integrator] of a scene asks for.
struct IntegratorChoice {
  std::string name;  ///< canonical
  time::SimulationOptions options;
  config::Parameters parameters;
};

/// Reads [integrator] with its tables for single methods: `type`, `time_step`, `end_time` and the method's parameters.
/// Keys directly in [integrator] win over those of [integrator.NAME]. Tables of methods that are not chosen are checked
/// as well. Nothing is returned where there was a mistake; all of them go to `diagnostics`. No module is loaded.
BUTEE_EXPORT std::optional<IntegratorChoice> read_integrator(const config::Value& root,
                                                             const plugin::Catalogue& catalogue,
                                                             config::Diagnostics& diagnostics);

/// Reports contacts of the model that the chosen method cannot treat, and names the methods that can.
BUTEE_EXPORT void check_contacts(const model::Model& model, const IntegratorChoice& choice,
                                 plugin::Catalogue& catalogue, const config::Value& root,
                                 config::Diagnostics& diagnostics);

/// Where an override (`--set integrator.type=NAME`) chose the method: takes out of [integrator] the file's direct keys
/// that belong to other methods alone, and says so in one line. Other keys, and overrides, stay for read_integrator()
/// to judge. Empty where there was nothing to do.
BUTEE_EXPORT std::string set_aside_keys(config::Document& document, const plugin::Catalogue& catalogue);

}  // namespace butee::scene

#pragma once

#include <optional>

#include "butee/plugin/catalogue.hpp"
#include "butee/time/simulation.hpp"

namespace butee::scene {

/// The content of [integrator].
struct IntegratorChoice {
  std::string name;  ///< canonical
  time::SimulationOptions options;
  config::Parameters parameters;
};

/// Reads [integrator] with its tables for single methods: `type`, `time_step`, `end_time` and the
/// method's parameters. Keys directly in [integrator] take precedence over those of
/// [integrator.NAME]. Tables of methods that are not chosen are also checked. If there are errors,
/// all go to `diagnostics` and nothing is returned. No module is loaded.
BUTEE_EXPORT std::optional<IntegratorChoice> read_integrator(const config::Value& root,
                                                             const plugin::Catalogue& catalogue,
                                                             config::Diagnostics& diagnostics);

/// Reports contacts of the model that the chosen method cannot treat, and names methods that can.
BUTEE_EXPORT void check_contacts(const model::Model& model, const IntegratorChoice& choice,
                                 plugin::Catalogue& catalogue, const config::Value& root,
                                 config::Diagnostics& diagnostics);

/// If an override (`--set integrator.type=NAME`) chose the method, removes from [integrator] the
/// file's direct keys that belong only to other methods, and returns a one-line message. Other
/// keys, and overrides, are left to read_integrator(). Empty if nothing was removed.
BUTEE_EXPORT std::string set_aside_keys(config::Document& document, const plugin::Catalogue& catalogue);

}  // namespace butee::scene

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

/// True unless the method (canonical name) follows the motion without truncation error, so that no tolerance applies.
BUTEE_EXPORT bool has_truncation(const std::string& method);
/// The tolerance that `method`, the chosen one or that which `auto` took, keeps; nothing if it has none.
BUTEE_EXPORT std::optional<double> tolerance_of(const IntegratorChoice& choice, const std::string& method);

/// The parameters of a method: those of all methods, and its own.
std::vector<config::Parameter> parameters_of(const plugin::IntegratorEntry& entry);

/// If an override (`--set integrator.type=NAME`) chose the method, removes from [integrator] the
/// file's direct keys that belong only to other methods, and returns a one-line message. Other
/// keys, and overrides, are left to read_integrator(). Empty if nothing was removed.
BUTEE_EXPORT std::string set_aside_keys(config::Document& document, const plugin::Catalogue& catalogue);

}  // namespace butee::scene

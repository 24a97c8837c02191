#pragma once

#include "butee/plugin/integrator_choice.hpp"

namespace butee::plugin {

/// A scene that was read without a mistake: the model and the method.
struct Scene {
  model::Model model;
  IntegratorChoice integrator;
};

/// Reads everything of a document but [output]. `others` are further keys of the root that somebody else reads.
/// Nothing is returned where there was a mistake; all of them go to `diagnostics`.
BUTEE_EXPORT std::optional<Scene> read_scene(const config::Document& document, const Catalogue& catalogue,
                                             config::Diagnostics& diagnostics,
                                             const std::vector<std::string>& others = {"output"});

}  // namespace butee::plugin

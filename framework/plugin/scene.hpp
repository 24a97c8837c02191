#pragma once

#include "butee/plugin/integrator_choice.hpp"

namespace butee::plugin {

/// A scene as read: the model and the method.
struct Scene {
  model::Model model;
  std::optional<IntegratorChoice> integrator;  ///< absent where [integrator] has a mistake
};

/// Reads everything of a document but [output]. `others` are further keys of the root that somebody else reads.
/// Every mistake goes to `diagnostics`; the scene can be run only where there is none.
BUTEE_EXPORT Scene read_scene(const config::Document& document, const Catalogue& catalogue,
                              config::Diagnostics& diagnostics, const std::vector<std::string>& others = {"output"});

}  // namespace butee::plugin

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/model/output_request.hpp"
#include "butee/scene/integrator_choice.hpp"

namespace butee::scene {

/// A scene as far as it could be read.
struct Draft {
  model::Model model;
  std::optional<IntegratorChoice> integrator;  ///< absent if [integrator] has an error
};

/// Reads all of a document except [output]. `others` are further keys of the root that are read
/// elsewhere. Every error goes to `diagnostics`; the scene can be run only if there is none. No
/// module is loaded.
BUTEE_EXPORT Draft read_draft(const config::Document& document, const plugin::Catalogue& catalogue,
                              config::Diagnostics& diagnostics, const std::vector<std::string>& others = {"output"});

/// A scene read, checked and ready to be assembled.
struct Scene {
  config::Document document;
  plugin::Catalogue catalogue;
  model::Model model;
  IntegratorChoice integrator;
  model::OutputRequest output;
  std::vector<std::string> warnings;
};

/// Whether [output] is read or ignored.
enum class Output { read, ignored };

/// Reads the scene, and loads the one module that it names. Throws InputError with all errors.
BUTEE_EXPORT Scene read_scene(config::Document document, plugin::Catalogue catalogue, Output output = Output::read);

/// The same from a file, with overrides ("integrator.tolerance=1e-8") and further folders or files of modules.
BUTEE_EXPORT Scene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                              const std::vector<std::string>& plugins = {});

}  // namespace butee::scene

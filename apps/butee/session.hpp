#pragma once

#include <string>
#include <vector>

#include <butee/scene/read_scene.hpp>

namespace butee::app {

/// Command-line arguments about a model file.
struct ModelArguments {
  std::string model;
  std::vector<std::string> overrides;
  std::vector<std::string> plugins;
};

/// Reads the scene. Throws InputError with all mistakes.
inline scene::Scene open_session(const ModelArguments& arguments) {
  return scene::load_scene(arguments.model, arguments.overrides, arguments.plugins);
}

}  // namespace butee::app

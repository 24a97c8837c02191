#pragma once

#include <memory>
#include <string>
#include <vector>

#include <butee/plugin/scene.hpp>
#include <butee/record/output_request.hpp>

namespace butee::app {

/// What the command line says about a model file.
struct ModelArguments {
  std::string model;
  std::vector<std::string> overrides;
  std::vector<std::string> plugins;
};

/// A scene read, checked and ready to be assembled.
struct Session {
  config::Document document;
  plugin::Catalogue catalogue;
  model::Model model;
  plugin::IntegratorChoice integrator;
  record::OutputRequest output;
  std::vector<std::string> warnings;
};

/// Reads the scene, and loads the one module that it names. Throws InputError with every mistake.
Session read_session(config::Document document, plugin::Catalogue catalogue);

/// The same from files and overrides.
Session open_session(const ModelArguments& arguments);

}  // namespace butee::app

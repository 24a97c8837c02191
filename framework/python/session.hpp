#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/scene/read_scene.hpp"

namespace butee::python {

/// One key of a scene and its new value; nothing: the key is taken out.
using Assignment = std::pair<std::string, std::optional<config::Value>>;

/// A scene that is valid at any time and may be changed. What runs holds the scene as it was when the run began.
///
/// Not for several threads at once, but for scene(), whose result is only read.
class Session {
 public:
  /// `plugins`: modules or folders of modules, which `catalogue` knows. Throws InputError with every mistake.
  Session(config::Document document, std::vector<std::string> plugins, const plugin::Catalogue& catalogue);

  const scene::Scene& scene() const { return *scene_; }
  std::shared_ptr<scene::Scene> shared() const { return scene_; }
  /// With the keys that reading set aside.
  const config::Document& document() const { return document_; }
  const std::vector<std::string>& plugins() const { return plugins_; }

  /// The same scene with other values, all of them at once. Throws InputError.
  Session with(const std::vector<Assignment>& assignments) const;

 private:
  config::Document document_;
  std::vector<std::string> plugins_;
  std::shared_ptr<scene::Scene> scene_;
};

void assign(config::Document& document, const std::vector<Assignment>& assignments);

}  // namespace butee::python

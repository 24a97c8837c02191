#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/scene/read_scene.hpp"

namespace butee::python {

/// One key of a scene and its new value; nothing: the key is removed.
using Assignment = std::pair<std::string, std::optional<config::Value>>;

/// A scene that is always valid and may be changed. A run keeps the scene as it was when the run
/// began.
///
/// Not thread-safe, except scene(), whose result is only read.
class Session {
 public:
  /// `plugins`: modules or folders of modules, which `catalogue` contains. Throws InputError with
  /// all errors.
  Session(config::Document document, std::vector<std::string> plugins, const plugin::Catalogue& catalogue);

  const scene::Scene& scene() const { return *scene_; }
  std::shared_ptr<scene::Scene> shared() const { return scene_; }
  /// The document, including the keys that reading set aside.
  const config::Document& document() const { return document_; }
  const std::vector<std::string>& plugins() const { return plugins_; }

  /// The same scene with several values changed at once. Throws InputError.
  Session with(const std::vector<Assignment>& assignments) const;

 private:
  config::Document document_;
  std::vector<std::string> plugins_;
  std::shared_ptr<scene::Scene> scene_;
};

void assign(config::Document& document, const std::vector<Assignment>& assignments);

}  // namespace butee::python

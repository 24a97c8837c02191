#include "butee/python/session.hpp"

#include "butee/config/override.hpp"
#include "butee/python/document_bytes.hpp"

namespace butee::python {

Session::Session(config::Document document, std::vector<std::string> plugins, const plugin::Catalogue& catalogue)
    : document_(std::move(document)),
      plugins_(std::move(plugins)),
      scene_(std::make_shared<scene::Scene>(scene::read_scene(document_, catalogue))) {}

Session Session::with(const std::vector<Assignment>& assignments) const {
  config::Document document = document_;
  assign(document, assignments);
  drop_unused_sources(document);
  return {std::move(document), plugins_, scene_->catalogue};
}

void assign(config::Document& document, const std::vector<Assignment>& assignments) {
  for (const auto& [key, value] : assignments) {
    if (value)
      config::apply_override(document, key, *value);
    else
      config::apply_override(document, key + "=");
  }
}

}  // namespace butee::python

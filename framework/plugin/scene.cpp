#include "butee/plugin/scene.hpp"

#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/model/read_model.hpp"

namespace butee::plugin {

Scene read_scene(const config::Document& document, const Catalogue& catalogue, config::Diagnostics& diagnostics,
                 const std::vector<std::string>& others) {
  std::vector<std::string> known = model::model_keys();
  known.emplace_back("integrator");
  known.insert(known.end(), others.begin(), others.end());
  for (const auto& [key, value] : document.root.table()->entries)
    if (std::find(known.begin(), known.end(), key) == known.end())
      diagnostics.error(key, value, "unknown key" + suggestion(key, known) + "; known here: " + join(known));

  model::Model model = model::read_model(document.root, catalogue.types(), diagnostics);
  auto integrator = read_integrator(document.root, catalogue, diagnostics);
  return {std::move(model), std::move(integrator)};
}

}  // namespace butee::plugin

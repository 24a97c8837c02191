#include "session.hpp"

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>

namespace butee::app {

Session open_session(const ModelArguments& arguments) {
  config::Document document = config::load_toml(arguments.model);
  for (const std::string& assignment : arguments.overrides) config::apply_override(document, assignment);
  auto catalogue = plugin::Catalogue::with_plugins(arguments.plugins);

  config::Diagnostics diagnostics(document);
  auto scene = plugin::read_scene(document, catalogue, diagnostics);
  const model::Model nothing;
  const auto output = record::read_output(document.root, scene ? scene->model : nothing,
                                          scene ? scene->integrator.options.end_time : 1.0, diagnostics);
  if (scene)
    if (const auto& check = catalogue.load(scene->integrator.name).check)
      check(scene->integrator.parameters, diagnostics);
  diagnostics.throw_if_any();
  return {std::move(document), std::move(catalogue), std::move(*scene), output, diagnostics.warnings()};
}

}  // namespace butee::app

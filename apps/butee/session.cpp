#include "session.hpp"

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>

namespace butee::app {

Session read_session(config::Document document, plugin::Catalogue catalogue) {
  const std::string set_aside = plugin::set_aside_keys(document, catalogue);
  config::Diagnostics diagnostics(document);
  plugin::Scene scene = plugin::read_scene(document, catalogue, diagnostics);
  const double end_time = scene.integrator ? scene.integrator->options.end_time : 1.0;
  record::OutputRequest output =
      record::read_output(document.root, scene.model, end_time, diagnostics, catalogue.types().formats);
  if (scene.integrator)
    if (const auto& check = catalogue.load(scene.integrator->name).check)
      check(scene.integrator->parameters, diagnostics);
  diagnostics.throw_if_any();
  std::vector<std::string> warnings = diagnostics.warnings();
  if (!set_aside.empty()) warnings.insert(warnings.begin(), set_aside);
  return {std::move(document),          std::move(catalogue), std::move(scene.model),
          std::move(*scene.integrator), std::move(output),    std::move(warnings)};
}

Session open_session(const ModelArguments& arguments) {
  config::Document document = config::load_toml(arguments.model);
  for (const std::string& assignment : arguments.overrides) config::apply_override(document, assignment);
  return read_session(std::move(document), plugin::Catalogue::with_plugins(arguments.plugins));
}

}  // namespace butee::app

#include "butee/scene/read_scene.hpp"

#include <algorithm>

#include "butee/config/override.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/scene/read_model.hpp"
#include "butee/scene/read_output.hpp"

namespace butee::scene {
namespace {

/// A name used in a scene may belong to a skipped module: adds this to the messages if a name is
/// unknown.
class LeftOut {
 public:
  LeftOut(const plugin::Catalogue& catalogue, config::Diagnostics& diagnostics)
      : catalogue_(catalogue), diagnostics_(diagnostics) {}

  void look_at(const config::Table& root) {
    if (catalogue_.left_out().empty()) return;
    const model::ModelTypes& types = catalogue_.types();
    look_at_entries(root, "element", "type", types.elements);
    look_at_entries(root, "contact", "law", types.laws);
    look_at_entries(root, "load", "type", types.loads);
    const config::Value* integrator = root.find("integrator");
    const config::Table* table = integrator != nullptr ? integrator->table() : nullptr;
    const config::Value* type = table != nullptr ? table->find("type") : nullptr;
    if (type != nullptr && type->text() != nullptr && catalogue_.find(*type->text()) == nullptr)
      report("integrator.type", *type);
    const config::Value* output = root.find("output");
    table = output != nullptr ? output->table() : nullptr;
    const config::Value* formats = table != nullptr ? table->find("formats") : nullptr;
    if (formats == nullptr || formats->array() == nullptr) return;
    for (const config::Value& format : *formats->array())
      if (format.text() != nullptr && *format.text() != "csv" && !find_type(types.formats, *format.text()))
        report("output.formats", format);
  }

 private:
  template <class Type>
  void look_at_entries(const config::Table& root, const char* list, const char* key, const std::vector<Type>& types) {
    const config::Value* entries = root.find(list);
    if (entries == nullptr || entries->array() == nullptr) return;
    for (const config::Value& entry : *entries->array()) {
      const config::Value* name = entry.table() != nullptr ? entry.table()->find(key) : nullptr;
      const bool is_known = name == nullptr || name->text() == nullptr || *name->text() == "distributed" ||
                            find_type(types, *name->text()) != nullptr;
      if (!is_known) report(std::string(list) + "." + key, *name);
    }
  }

  void report(const std::string& key, const config::Value& name) {
    diagnostics_.error(key, name,
                       "may belong to a module that could not be read. " + join(catalogue_.left_out(), "; "));
  }

  const plugin::Catalogue& catalogue_;
  config::Diagnostics& diagnostics_;
};

/// The command that performs the study of this file; "" if it is no study.
std::string command_for_study(const config::Table& root) {
  if (root.find("element") != nullptr) return "";
  if (root.find("scene") != nullptr) return "study";
  return root.find("study") != nullptr ? "compare" : "";
}

}  // namespace

Draft read_draft(const config::Document& document, const plugin::Catalogue& catalogue, config::Diagnostics& diagnostics,
                 const std::vector<std::string>& others) {
  std::vector<std::string> known = model_keys();
  known.emplace_back("integrator");
  known.insert(known.end(), others.begin(), others.end());
  for (const auto& [key, value] : document.root.table()->entries)
    if (std::find(known.begin(), known.end(), key) == known.end())
      diagnostics.error(key, value, "unknown key" + suggestion(key, known) + "; known here: " + join(known));

  model::Model model = read_model(document.root, catalogue.types(), diagnostics);
  auto integrator = read_integrator(document.root, catalogue, diagnostics);
  LeftOut(catalogue, diagnostics).look_at(*document.root.table());
  return {std::move(model), std::move(integrator)};
}

Scene read_scene(config::Document document, plugin::Catalogue catalogue, Output output) {
  const std::string set_aside = set_aside_keys(document, catalogue);
  config::Diagnostics diagnostics(document);
  Draft draft = read_draft(document, catalogue, diagnostics);
  const double end_time = draft.integrator ? draft.integrator->options.end_time : 1.0;
  model::OutputRequest request;
  if (output == Output::read)
    request = read_output(document.root, draft.model, end_time, diagnostics, catalogue.types().formats);
  if (draft.integrator)
    if (const auto& check = catalogue.load(draft.integrator->name).check)
      check(draft.integrator->parameters, diagnostics);
  diagnostics.throw_if_any();
  std::vector<std::string> warnings = diagnostics.warnings();
  if (!set_aside.empty()) warnings.insert(warnings.begin(), set_aside);
  return {std::move(document),          std::move(catalogue), std::move(draft.model),
          std::move(*draft.integrator), std::move(request),   std::move(warnings)};
}

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                 const std::vector<std::string>& plugins) {
  config::Document document = config::load_toml(path);
  if (const std::string command = command_for_study(*document.root.table()); !command.empty())
    throw InputError(path + ": is not a scene but a study of scenes, which `butee " + command + "` performs");
  for (const std::string& assignment : overrides) config::apply_override(document, assignment);
  return read_scene(std::move(document), plugin::Catalogue::with_plugins(plugins));
}

}  // namespace butee::scene

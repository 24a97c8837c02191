#include "butee/plugin/scene.hpp"

#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/model/read_model.hpp"

namespace butee::plugin {
namespace {

/// Names that a scene uses may be those of modules that were left out: says so where one of them is unknown.
class LeftOut {
 public:
  LeftOut(const Catalogue& catalogue, config::Diagnostics& diagnostics)
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
    diagnostics_.error(key, name, "may be of a module that could not be read. " + join(catalogue_.left_out(), "; "));
  }

  const Catalogue& catalogue_;
  config::Diagnostics& diagnostics_;
};

}  // namespace

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
  LeftOut(catalogue, diagnostics).look_at(*document.root.table());
  return {std::move(model), std::move(integrator)};
}

}  // namespace butee::plugin

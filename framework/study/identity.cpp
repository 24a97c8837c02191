#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/target.hpp"
#include "butee/plugin/module.hpp"
#include "butee/study/store.hpp"
#include "butee/version.hpp"

namespace butee::study {
namespace {

namespace fs = std::filesystem;

/// Values read from files beside the study.
std::string values_of_files(const Plan& plan) {
  std::string text;
  for (const Axis& axis : plan.axes())
    for (const config::Value& value : axis.values) text += config::to_toml(value) + "\n";
  return text;
}

/// The library and all modules that a scene may use.
std::string checksum_of_build(const plugin::Catalogue& catalogue) {
  std::string all;
  const auto add = [&](const std::string& file) {
    if (!file.empty() && fs::exists(file)) all += config::checksum_text(config::read_text(file));
  };
  add(plugin::library_file());
  for (const std::string& module : catalogue.modules()) add(module);
  return config::checksum_text(all);
}

std::string text_in(const config::Document& document, const char* key) {
  const config::Value* identity = document.root.table()->find("identity");
  const config::Value* value =
      identity != nullptr && identity->table() != nullptr ? identity->table()->find(key) : nullptr;
  return value != nullptr && value->text() != nullptr ? *value->text() : "";
}

}  // namespace

Identity identity_of(const Study& study) {
  const std::string folder = fs::path(study.scene.sources.front()).parent_path().string();
  const std::string scene =
      config::write_toml(config::with_files_found_from(study.scene, folder.empty() ? "." : folder));
  return {config::checksum_text(config::write_toml(*study.document.root.table()) + values_of_files(study.plan)),
          config::checksum_text(scene),
          "butee " BUTEE_VERSION ", " + target() + ", " + compiled_for() + ", " + checksum_of_build(study.catalogue)};
}

void Store::adopt_identity() {
  const config::Document known = config::load_toml((fs::path(study_in(folder_)) / kStudyFile).string());
  identity_ = {text_in(known, "study"), text_in(known, "scene"), text_in(known, "build")};
}

void Store::check_identity(const std::string& folder) const {
  const config::Document known = config::load_toml((fs::path(folder) / kStudyFile).string());
  const std::pair<const char*, std::pair<std::string, const char*>> parts[] = {
      {"study", {identity_.study, "the study (what varies, how, and what is collected)"}},
      {"scene", {identity_.scene, "the scene, or a file that it names"}},
      {"build", {identity_.build, "butee itself"}}};
  for (const auto& [key, part] : parts)
    if (const std::string was = text_in(known, key); was != part.first)
      throw InputError(
          folder + ": " + part.second + " has changed since the rows there were computed (" + was + ", now " +
          part.first +
          "), so that they do not belong together; choose another folder with -o, or --fresh to start again");
}

}  // namespace butee::study

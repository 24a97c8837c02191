#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/target.hpp"
#include "butee/plugin/module.hpp"
#include "butee/study/store.hpp"
#include "butee/version.hpp"

namespace butee::study {
namespace {

namespace fs = std::filesystem;

/// Values that come from files beside the study.
std::string values_of_files(const Plan& plan) {
  std::string text;
  for (const Axis& axis : plan.axes())
    for (const config::Value& value : axis.values) text += config::to_toml(value) + "\n";
  return text;
}

/// The library and the modules of methods.
std::string checksum_of_build(const plugin::Catalogue& catalogue) {
  std::string all;
  const auto add = [&](const std::string& file) {
    if (!file.empty() && fs::exists(file)) all += config::checksum_text(config::read_text(file));
  };
  add(plugin::library_file());
  std::string last;
  for (const plugin::IntegratorEntry& entry : catalogue.integrators())
    if (entry.module != last) add(last = entry.module);
  return config::checksum_text(all);
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

}  // namespace butee::study

#include "butee/plugin/catalogue.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/plugin/builtin.hpp"
#include "butee/plugin/module.hpp"

namespace butee::plugin {

namespace fs = std::filesystem;
using time::IntegratorType;

namespace {

constexpr const char* kModuleExtension = ".so";

bool answers_to(const IntegratorType& type, std::string_view name) {
  return type.name == name || std::find(type.aliases.begin(), type.aliases.end(), name) != type.aliases.end();
}

}  // namespace

Catalogue::Catalogue() : types_(builtin_types()) {}

Catalogue Catalogue::with_plugins(const std::vector<std::string>& extra) {
  Catalogue catalogue;
  if (const std::string folder = standard_plugin_folder(); fs::is_directory(folder)) catalogue.add(folder);
  if (const char* path = std::getenv("BUTEE_PLUGIN_PATH")) {
    std::istringstream folders(path);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (!folder.empty()) catalogue.add(folder);
  }
  for (const std::string& item : extra) catalogue.add(item);
  return catalogue;
}

void Catalogue::add(const std::string& file_or_folder) {
  if (!fs::exists(file_or_folder)) throw InputError(file_or_folder + ": there is no such module or folder of modules");
  if (fs::is_directory(file_or_folder))
    add_folder(file_or_folder);
  else
    add_module(file_or_folder, false);
}

void Catalogue::add_folder(const std::string& path) {
  std::set<std::string> modules;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.path().extension() == kModuleExtension) modules.insert(entry.path().string());
  for (const std::string& module : modules) add_module(module, true);
}

void Catalogue::add_module(const std::string& given_path, bool must_have_manifest) {
  const std::string path = fs::weakly_canonical(given_path).string();
  if (std::any_of(integrators_.begin(), integrators_.end(), [&](const auto& entry) { return entry.module == path; }))
    return;
  const std::string manifest = manifest_path(path);
  std::vector<IntegratorType> found;
  if (fs::exists(manifest)) {
    found = read_manifest(manifest).integrators;
  } else if (must_have_manifest) {
    return log::warning(path + ": has no manifest (" + manifest +
                        ") and is left out; name it with --plugin to load it");
  } else {
    found = std::move(load_module(path).integrators());
  }
  for (const IntegratorType& type : found) {
    std::vector<std::string> names = type.aliases;
    names.push_back(type.name);
    for (const std::string& name : names)
      if (const IntegratorEntry* taken = find(name))
        throw RunError("the integrator name \"" + name + "\" is registered twice: by " + taken->module + " and by " +
                       path + "; remove one of the two");
  }
  for (IntegratorType& type : found) integrators_.push_back({std::move(type), path});
}

const IntegratorEntry* Catalogue::find(std::string_view name) const {
  const auto found = std::find_if(integrators_.begin(), integrators_.end(),
                                  [&](const auto& entry) { return answers_to(entry.declaration, name); });
  return found == integrators_.end() ? nullptr : &*found;
}

std::vector<std::string> Catalogue::integrator_names() const {
  std::vector<std::string> names;
  for (const auto& entry : integrators_) names.push_back(entry.declaration.name);
  for (const auto& entry : integrators_)
    names.insert(names.end(), entry.declaration.aliases.begin(), entry.declaration.aliases.end());
  return names;
}

const IntegratorType& Catalogue::load(std::string_view name) {
  const IntegratorEntry* known = find(name);
  require(known != nullptr, "no such integrator");
  IntegratorEntry& entry = integrators_[static_cast<std::size_t>(known - integrators_.data())];
  if (!entry.declaration.make) {
    log::debug("loading " + entry.module);
    Registrar loaded = load_module(entry.module);
    for (IntegratorType& type : loaded.integrators())
      if (type.name == entry.declaration.name) entry.declaration = std::move(type);
    if (!entry.declaration.make)
      throw RunError(entry.module + ": does not register " + entry.declaration.name +
                     ", which its manifest names; the manifest is stale: build the module again");
  }
  return entry.declaration;
}

}  // namespace butee::plugin

#pragma once

#include <string>

#include "butee/plugin/registrar.hpp"

namespace butee::plugin {

/// "module.so" -> "module.toml": the manifest is next to its module.
BUTEE_EXPORT std::string manifest_path(const std::string& module);

/// The manifest as TOML text; written at build time from the module's own declaration.
BUTEE_EXPORT std::string write_manifest(const ModuleTypes& types);

/// The types of a module, read without loading it: they have no factories. Throws InputError if the
/// file is not a manifest.
BUTEE_EXPORT ModuleTypes read_manifest(const std::string& path);

}  // namespace butee::plugin

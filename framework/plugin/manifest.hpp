#pragma once

#include <string>

#include "butee/plugin/registrar.hpp"

namespace butee::plugin {

/// "module.so" -> "module.toml": the manifest stands beside its module.
BUTEE_EXPORT std::string manifest_path(const std::string& module);

/// The manifest as TOML text; written at build time from the module's own declaration.
BUTEE_EXPORT std::string write_manifest(const ModuleTypes& types);

/// What a module holds, without loading it: the types have no maker. Throws InputError where the file is no manifest.
BUTEE_EXPORT ModuleTypes read_manifest(const std::string& path);

}  // namespace butee::plugin

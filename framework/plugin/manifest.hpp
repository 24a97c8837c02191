#pragma once

#include <string>
#include <vector>

#include "butee/time/integrator.hpp"

namespace butee::plugin {

/// What a module holds, readable without loading it. The types have no maker.
struct Manifest {
  std::vector<time::IntegratorType> integrators;
};

/// "module.so" -> "module.toml": the manifest stands beside its module.
BUTEE_EXPORT std::string manifest_path(const std::string& module);

/// The manifest as TOML text; written at build time from the module's own declaration.
BUTEE_EXPORT std::string write_manifest(const std::vector<time::IntegratorType>& integrators);

/// Throws InputError where the file is no manifest.
BUTEE_EXPORT Manifest read_manifest(const std::string& path);

}  // namespace butee::plugin

#pragma once

#include <string>

#include "butee/plugin/registrar.hpp"

namespace butee::plugin {

/// Opens a shared object, or the one of the same name in a subfolder beside it that is named after
/// the chosen instruction set (core/target.hpp) or a lower one; compares its ABI tag field by field
/// and lets it register its types.
///
/// A module is never unloaded: objects of its types may outlive all references to it. Throws
/// RunError with the file's name and the expected and actual values.
BUTEE_EXPORT Registrar load_module(const std::string& path);

/// A C function of a shared object, opened as by load_module(). Throws RunError likewise.
BUTEE_EXPORT void (*module_function(const std::string& path, const char* name))();

/// The file of the framework's library; "" if the system does not provide it.
BUTEE_EXPORT std::string library_file();

/// The folder of the modules that come with butee, beside the library of the framework.
BUTEE_EXPORT std::string standard_plugin_folder();

}  // namespace butee::plugin

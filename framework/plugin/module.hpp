#pragma once

#include <string>

#include "butee/plugin/registrar.hpp"

namespace butee::plugin {

/// Opens a shared object, or the one of its name in a folder beside it that is called like the chosen instruction set
/// (core/target.hpp) or a lower one; compares its ABI tag field by field and lets it register its types.
///
/// A module is never unloaded: objects of its types may outlive everything that knows of it. Throws RunError with the
/// file's name, what was expected and what was found.
BUTEE_EXPORT Registrar load_module(const std::string& path);

/// A C function of a shared object that is opened as by load_module(). Throws RunError likewise.
BUTEE_EXPORT void (*module_function(const std::string& path, const char* name))();

/// The file of the library of the framework; "" where the system does not say.
BUTEE_EXPORT std::string library_file();

/// The folder of the modules that come with butee, beside the library of the framework.
BUTEE_EXPORT std::string standard_plugin_folder();

}  // namespace butee::plugin

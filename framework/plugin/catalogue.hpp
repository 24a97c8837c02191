#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "butee/model/types.hpp"
#include "butee/plugin/manifest.hpp"

namespace butee::plugin {

/// A method that a scene may name, and the location of its code.
struct IntegratorEntry {
  time::IntegratorType declaration;  ///< from the manifest, with its factory once its module is loaded
  std::string module;                ///< the shared object's path
};

/// All types that a scene may name. Types of modules are known from the manifests next to them; a
/// module is loaded when one of its types is made.
class BUTEE_EXPORT Catalogue {
 public:
  /// The standard elements, laws and loads; no integrator yet.
  Catalogue();

  /// The standard modules, those of BUTEE_PLUGIN_PATH (folders separated by ':'), and `extra` files
  /// or folders.
  static Catalogue with_plugins(const std::vector<std::string>& extra = {});

  /// Adds a module, or every module of a folder (files *.so with a manifest). A single file without
  /// a manifest is loaded to learn its names. Throws RunError for a broken module and for a name
  /// that is already used, naming both files, and InputError for a broken manifest of a single
  /// file; one in a folder causes a warning and its module is skipped.
  void add(const std::string& file_or_folder);

  /// Adds types of this process, all or none of them; `origin` names their source in messages.
  void add(ModuleTypes found, const std::string& origin);

  /// The skipped modules, each with the reason: "FILE: is ignored: ...".
  const std::vector<std::string>& left_out() const { return left_out_; }

  const model::ModelTypes& types() const { return types_; }
  const std::vector<IntegratorEntry>& integrators() const { return integrators_; }

  /// The paths of all modules, in alphabetical order.
  const std::set<std::string>& modules() const { return known_; }
  /// The module of a law, load or element; "" for those of the library.
  std::string module_of(const std::string& kind, const std::string& name) const;

  /// The entry of a name or an alias, or nullptr.
  const IntegratorEntry* find(std::string_view name) const;
  /// All names, followed by all aliases.
  std::vector<std::string> integrator_names() const;

  /// Loads the module of `name` (or an alias) if necessary, and returns its type with its factory.
  const time::IntegratorType& load(std::string_view name);

 private:
  void add_module(const std::string& path, bool is_in_folder);
  void leave_out(const std::string& path, const std::string& reason);
  void add_folder(const std::string& path);
  /// Adds types of one kind whose factories load the module at their first use.
  template <class Type>
  void add_types(const char* kind, std::vector<Type> found, std::vector<Type> ModuleTypes::*list,
                 const std::string& path, std::vector<Type>& to);

  model::ModelTypes types_;
  std::vector<IntegratorEntry> integrators_;
  std::map<std::pair<std::string, std::string>, std::string> modules_;  ///< by kind and name
  std::set<std::string> known_;                                         ///< the paths of all modules
  std::vector<std::string> left_out_;
};

}  // namespace butee::plugin

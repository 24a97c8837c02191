#include "butee/plugin/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <set>
#include <sstream>
#include <tuple>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
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

[[noreturn]] void refuse(const std::string& kind, const std::string& name, const std::string& by,
                         const std::string& path) {
  throw RunError("the " + kind + " name \"" + name + "\" is registered twice: by " + by + " and by " + path +
                 "; remove one of the two");
}

/// Names of types, and keys of every table of a kind, that the readers of a scene treat themselves. Those of contacts
/// are checked where a law is used.
struct Reserved {
  const char* kind;
  std::vector<std::string> types, keys;
};

const Reserved* reserved_for(const std::string& kind) {
  static const std::array<Reserved, 3> all = {{{"contact", {"stop", "friction"}, {"type"}},
                                               {"load", {"distributed"}, {"type", "node", "dof"}},
                                               {"element", {}, {"type", "name"}}}};
  const auto* const found = std::find_if(all.begin(), all.end(), [&](const Reserved& one) { return one.kind == kind; });
  return found == all.end() ? nullptr : &*found;
}

template <class Type>
void require_names(const std::string& kind, const Type& type, const std::string& path) {
  if (type.name.empty()) throw RunError(path + ": registers a type of " + kind + " without a name");
  std::set<std::string> names;
  std::vector<std::string> given = config::names_of(type.parameters);
  given.push_back(type.name);
  for (const std::string& name : given)
    if (!name.empty() && !is_plain_name(name))
      throw RunError(path + ": the " + kind + " \"" + printable(type.name) + "\" uses the name \"" + printable(name) +
                     "\"; names are of letters, digits, _ and - only");
  for (const config::Parameter& parameter : type.parameters)
    if (parameter.name.empty() || !names.insert(parameter.name).second)
      throw RunError(
          path + ": the " + kind + " \"" + type.name + "\" declares " +
          (parameter.name.empty() ? "a parameter without a name" : "the parameter \"" + parameter.name + "\" twice"));
  for (const config::Parameter& parameter : type.parameters)
    for (const auto& [what, value] :
         {std::pair("default", &parameter.fallback), std::pair("value to try first", &parameter.first_try)})
      if (const std::string wrong = *value ? parameter.complaint(**value) : ""; !wrong.empty())
        throw RunError(path + ": the " + kind + " \"" + type.name + "\" declares a " + what + " of the parameter \"" +
                       parameter.name + "\" that it does not allow itself: " + wrong);
  const Reserved* reserved = reserved_for(kind);
  if (reserved == nullptr) return;
  if (std::find(reserved->types.begin(), reserved->types.end(), type.name) != reserved->types.end())
    refuse(kind, type.name, "butee itself", path);
  for (const std::string& key : reserved->keys)
    if (names.contains(key))
      throw RunError(path + ": the " + kind + " \"" + type.name + "\" declares the parameter \"" + key +
                     "\", a key that every [[" + kind + "]] has; rename it");
}

/// Throws RunError unless the limits and the order that a method declares are positive numbers.
void require_limits(const IntegratorType& type, const std::string& path) {
  for (const auto& [name, value, is_allowed] :
       {std::tuple("stability_limit", type.stability_limit, type.stability_limit > 0.0),
        std::tuple("damping_limit", type.damping_limit, type.damping_limit > 0.0),
        std::tuple("order", type.order, type.order >= 0.0 && std::isfinite(type.order))})
    if (!is_allowed)
      throw RunError(path + ": the integrator \"" + type.name + "\" declares " + name + " = " + to_text(value) +
                     "; it must be " + (std::string_view(name) == "order" ? "a number >= 0" : "> 0, or infinity"));
}

/// The type of that name in the module, which is loaded now.
template <class Type>
Type loaded(const std::string& name, std::vector<Type> ModuleTypes::*list, const std::string& path) {
  log::debug("loading " + path);
  Registrar registrar = load_module(path);
  for (Type& type : registrar.types().*list)
    if (type.name == name && type.make) return std::move(type);
  throw RunError(path + ": does not register " + name +
                 ", which its manifest names; the manifest is stale: build the module again");
}

/// Gives a type known from its manifest factories that load the module.
template <class Type>
void load_when_made(Type& type, std::vector<Type> ModuleTypes::*list, const std::string& path) {
  const std::string name = type.name;
  type.make = [name, list, path](const auto& first, auto&&... others) {
    return loaded(name, list, path).make(first, std::forward<decltype(others)>(others)...);
  };
  if constexpr (std::is_same_v<Type, model::ElementType>)
    type.nodes = [name, list, path](const config::Parameters& p, config::Diagnostics& diagnostics) {
      return loaded(name, list, path).nodes(p, diagnostics);
    };
  if constexpr (std::is_same_v<Type, model::FieldFormat>)
    type.open = [name, list, path](const std::string& folder) { return loaded(name, list, path).open(folder); };
}

/// Calls what a module made; its exceptions become errors that name it.
template <class Call>
auto named_on_failure(const std::string& what, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const LogicError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw RunError(what + " failed: " + error.what());
  } catch (...) {
    throw RunError(what + " failed: it threw an exception that is not a std::exception");
  }
}

/// The errors of the scene so far: where there are some, a factory may lack what they spoiled, and need not report it.
std::size_t errors_in(const config::Diagnostics& diagnostics) {
  return diagnostics.error_count();
}
std::size_t errors_in(model::ElementContext& context) {
  return context.diagnostics().error_count();
}
std::size_t errors_in(const model::FieldLayout&) {
  return 0;
}

/// Makes the factories of a type throw RunError with the module's name for exceptions of other kinds, and for a result
/// that is missing although no error was reported.
template <class Type>
void check_factories(Type& type, const std::string& kind, const std::string& path) {
  const std::string what = path + ": making the " + kind + " \"" + type.name + "\"";
  type.make = [make = std::move(type.make), what](const auto& first, auto&&... others) {
    auto& last = std::get<sizeof...(others) - 1>(std::tie(others...));
    auto made = named_on_failure(what, [&] { return make(first, std::forward<decltype(others)>(others)...); });
    if (made == nullptr && errors_in(last) == 0) throw RunError(what + " gave nothing, and reported no error");
    if constexpr (std::is_same_v<Type, model::LawType>)
      if (made != nullptr && !(made->closed_stiffness() > 0.0 && std::isfinite(made->closed_stiffness())))
        throw RunError(what + " gave one with a closed_stiffness() of " + to_text(made->closed_stiffness()) + " N/m");
    return made;
  };
  if constexpr (std::is_same_v<Type, model::ElementType>) {
    if (!type.nodes) throw RunError(path + ": the element \"" + type.name + "\" has no function `nodes`");
    type.nodes = [nodes = std::move(type.nodes), what](const config::Parameters& p, config::Diagnostics& diagnostics) {
      return named_on_failure(what, [&] { return nodes(p, diagnostics); });
    };
  }
}

}  // namespace

Catalogue::Catalogue() : types_(builtin_types()) {}

Catalogue Catalogue::with_plugins(const std::vector<std::string>& extra) {
  Catalogue catalogue;
  if (const std::string folder = standard_plugin_folder(); fs::is_directory(folder)) catalogue.add(folder);
  if (const char* path = std::getenv("BUTEE_PLUGIN_PATH")) {
    std::istringstream folders(path);
    for (std::string folder; std::getline(folders, folder, ':');) try {
        if (!folder.empty()) catalogue.add(folder);
      } catch (const InputError& error) {
        throw InputError(std::string("BUTEE_PLUGIN_PATH: ") + error.what());
      }
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

void Catalogue::leave_out(const std::string& path, const std::string& reason) {
  left_out_.push_back(path + ": is ignored: " + reason);
  log::warning(left_out_.back());
}

void Catalogue::add_module(const std::string& given_path, bool is_in_folder) {
  const std::string path = fs::weakly_canonical(given_path).string();
  if (known_.contains(path)) return;
  const std::string manifest = manifest_path(path);
  ModuleTypes found;
  if (fs::exists(manifest)) {
    try {
      found = read_manifest(manifest);
    } catch (const InputError& error) {
      if (!is_in_folder) throw;
      return leave_out(path, std::string(error.what()) + "; build the module again");
    }
  } else if (is_in_folder) {
    return leave_out(path, "it has no manifest (" + manifest + "); name it with --plugin to load it");
  } else {
    found = std::move(load_module(path).types());
  }
  add(std::move(found), path);
  known_.insert(path);
}

void Catalogue::add(ModuleTypes found, const std::string& path) {
  // All or nothing: a copy receives the types, and is kept only if none is refused.
  Catalogue next = *this;
  next.add_types("law", std::move(found.laws), &ModuleTypes::laws, path, next.types_.laws);
  next.add_types("contact", std::move(found.contacts), &ModuleTypes::contacts, path, next.types_.contacts);
  next.add_types("load", std::move(found.loads), &ModuleTypes::loads, path, next.types_.loads);
  next.add_types("element", std::move(found.elements), &ModuleTypes::elements, path, next.types_.elements);
  next.add_types("format", std::move(found.formats), &ModuleTypes::formats, path, next.types_.formats);
  for (IntegratorType& type : found.integrators) {
    require_names("integrator", type, path);
    require_limits(type, path);
    std::vector<std::string> names = type.aliases;
    names.push_back(type.name);
    for (const std::string& name : names)
      if (const IntegratorEntry* taken = next.find(name)) refuse("integrator", name, taken->module, path);
    next.integrators_.push_back({std::move(type), path});
  }
  *this = std::move(next);
}

template <class Type>
void Catalogue::add_types(const char* kind, std::vector<Type> found, std::vector<Type> ModuleTypes::*list,
                          const std::string& path, std::vector<Type>& to) {
  for (Type& type : found) {
    require_names(kind, type, path);
    if (model::find_type(to, type.name) != nullptr) {
      const std::string taken = module_of(kind, type.name);
      refuse(kind, type.name, taken.empty() ? "butee itself" : taken, path);
    }
    modules_[{kind, type.name}] = path;
    if (!type.make) load_when_made(type, list, path);
    check_factories(type, kind, path);
    to.push_back(std::move(type));
  }
}

std::string Catalogue::module_of(const std::string& kind, const std::string& name) const {
  const auto found = modules_.find({kind, name});
  return found == modules_.end() ? "" : found->second;
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
  if (!entry.declaration.make)
    entry.declaration = loaded(entry.declaration.name, &ModuleTypes::integrators, entry.module);
  return entry.declaration;
}

}  // namespace butee::plugin

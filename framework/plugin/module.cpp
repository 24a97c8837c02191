#include "butee/plugin/module.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>

#include "butee/core/error.hpp"
#include "butee/core/target.hpp"
#include "butee/core/text.hpp"
#include "butee/plugin/abi.hpp"
#include "butee/plugin/crash_watch.hpp"

namespace butee::plugin {
namespace {

std::string last_error() {
  const char* message = dlerror();
  return message != nullptr ? message : "no reason given";
}

template <class Function>
Function symbol(void* handle, const char* name, const std::string& path) {
  auto* address = dlsym(handle, name);
  if (address == nullptr)
    throw RunError(path + ": is not a butee module: it has no " + name + " (" + last_error() + ")");
  return reinterpret_cast<Function>(address);
}

std::string differences(const butee_abi_tag& theirs) {
  const butee_abi_tag ours = abi_tag();
  std::vector<std::string> found;
  const auto compare = [&](const char* what, std::uint32_t expected, std::uint32_t given) {
    if (expected != given)
      found.push_back(std::string(what) + " " + std::to_string(given) + " instead of " + std::to_string(expected));
  };
  compare("tag size", ours.size, theirs.size);
  if (!found.empty()) return join(found);
  compare("interface version", ours.interface_version, theirs.interface_version);
  compare("Eigen version", ours.eigen_version, theirs.eigen_version);
  compare("Eigen alignment (EIGEN_MAX_ALIGN_BYTES)", ours.eigen_alignment, theirs.eigen_alignment);
  compare("Eigen layout (index size, storage order)", ours.eigen_layout, theirs.eigen_layout);
  compare("C++11 ABI (_GLIBCXX_USE_CXX11_ABI)", ours.cxx11_abi, theirs.cxx11_abi);
  compare("checked standard library (_GLIBCXX_DEBUG)", ours.checked_library, theirs.checked_library);
  compare("AddressSanitizer", ours.sanitizers, theirs.sanitizers);
  compare("pointer size", ours.pointer_bytes, theirs.pointer_bytes);
  return join(found);
}

/// The same module for the chosen instruction set, or for the next lower one for which a folder of
/// that name exists beside it.
std::string for_target(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file(path);
  const std::vector<std::string> all = targets();
  for (auto name = std::find(all.begin(), all.end(), target()); name != all.end(); ++name) {
    const fs::path own = file.parent_path() / *name / file.filename();
    std::error_code error;
    if (fs::is_regular_file(own, error)) return own.string();
  }
  return path;
}

/// Opens a module and checks its compatibility. To be called under a CrashWatch.
void* open_module(const std::string& path) {
  // dlopen searches the folders of system libraries for a name without a folder.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
  if (handle == nullptr) throw RunError(path + ": cannot be loaded: " + last_error());
  const auto tag = symbol<const butee_abi_tag* (*)()>(handle, "butee_plugin_abi", path);
  if (const std::string found = differences(*tag()); !found.empty())
    throw RunError(path + ": was built for another butee: " + found +
                   "; build it again with this version's headers and flags");
  // Resolves all its functions only now, so that a missing one does not cause a crash in the middle
  // of a run.
  if (dlopen(file.c_str(), RTLD_NOW | RTLD_NOLOAD) == nullptr)
    throw RunError(path + ": cannot be loaded: " + last_error() +
                   "; build it again with this version's headers and flags");
  return handle;
}

}  // namespace

Registrar load_module(const std::string& any_path) {
  const std::string path = for_target(any_path);
  const CrashWatch watch(path);
  void* handle = open_module(path);
  const auto enter = symbol<void (*)(Registrar*)>(handle, "butee_plugin_register", path);
  Registrar registrar;
  try {
    enter(&registrar);
  } catch (const std::exception& error) {
    throw RunError(path + ": failed while registering: " + error.what());
  } catch (...) {
    throw RunError(path + ": failed while registering, with an exception that is not a std::exception");
  }
  return registrar;
}

void (*module_function(const std::string& path, const char* name))() {
  const CrashWatch watch(path);
  return symbol<void (*)()>(open_module(path), name, path);
}

std::string library_file() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&library_file), &info) == 0 || info.dli_fname == nullptr) return "";
  return std::filesystem::weakly_canonical(info.dli_fname).string();
}

std::string standard_plugin_folder() {
  const std::filesystem::path library = library_file();
  return library.empty() ? "" : (library.parent_path() / "butee" / "plugins").string();
}

}  // namespace butee::plugin

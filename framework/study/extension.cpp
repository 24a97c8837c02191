#include "butee/study/extension.hpp"

#include <filesystem>

#include "butee/plugin/module.hpp"

namespace butee::study {

Maker find_extension(const std::string& module, const char* function) {
  const std::string plugins = plugin::standard_plugin_folder();
  const auto path = std::filesystem::path(plugins).parent_path() / "study" / (module + ".so");
  if (plugins.empty() || !std::filesystem::exists(path)) return nullptr;
  return reinterpret_cast<Maker>(plugin::module_function(path.string(), function));
}

}  // namespace butee::study

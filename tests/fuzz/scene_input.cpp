#include "scene_input.hpp"

#include <string>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>

#include "integrators/methods.hpp"

namespace butee::fuzz {
namespace {

constexpr std::int64_t kMostElements = 16;

/// Limits every number under the key `elements`.
void shrink(config::Value& value) {
  if (config::Array* array = value.array())
    for (config::Value& item : *array) shrink(item);
  if (config::Table* table = value.table())
    for (auto& [key, item] : table->entries) {
      auto* count = std::get_if<std::int64_t>(&item.data);
      if (key == "elements" && count != nullptr && *count > kMostElements) *count = 1 + *count % kMostElements;
      shrink(item);
    }
}

}  // namespace

plugin::Catalogue& catalogue() {
  static plugin::Catalogue instance = [] {
    using namespace integrators;
    log::set_level(log::Level::quiet);
    plugin::ModuleTypes types;
    types.integrators = {auto_type(),
                         bathe_type(),
                         bathe_adaptive_type(),
                         central_differences_type(),
                         central_differences_adaptive_type(),
                         discrete_gradient_type(),
                         discrete_gradient_adaptive_type(),
                         dopri5_type(),
                         exact_type(),
                         extrapolation8_type(),
                         exponential_type(),
                         generalized_alpha_type(),
                         generalized_alpha_adaptive_type(),
                         hht_alpha_type(),
                         hht_alpha_adaptive_type(),
                         piecewise_type(),
                         rodas4_type(),
                         rk4_type(),
                         rk4_fixed_factors_type(),
                         rk4_error_scaled_type(),
                         newmark_type(),
                         newmark_adaptive_type(),
                         newmark_modified_type(),
                         newmark_modified_adaptive_type()};
    plugin::Catalogue made;
    made.add(std::move(types), "the fuzz target");
    return made;
  }();
  return instance;
}

std::optional<scene::Scene> read_scene_input(const std::uint8_t* data, std::size_t size) {
  try {
    config::Document document = config::parse_toml(std::string(reinterpret_cast<const char*>(data), size), "input");
    shrink(document.root);
    // The written model must be readable again.
    config::parse_toml(config::write_toml(*document.root.table()), "written");
    return scene::read_scene(std::move(document), catalogue());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace butee::fuzz

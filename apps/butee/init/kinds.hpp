#pragma once

#include <string_view>
#include <vector>

namespace butee::app::init {

/// A template for a new scene: apps/templates/NAME.toml; its first line is a comment that describes it.
struct Kind {
  std::string_view name, text;

  std::string_view summary() const { return text.substr(2, text.find('\n') - 2); }
};

/// In alphabetical order; generated at build time from the files.
const std::vector<Kind>& kinds();

}  // namespace butee::app::init

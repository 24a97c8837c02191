#pragma once

#include <string_view>
#include <vector>

namespace butee::app::init {

/// A scene to start from: apps/templates/NAME.toml, whose first line is a comment that says what it is.
struct Kind {
  std::string_view name, text;

  std::string_view summary() const { return text.substr(2, text.find('\n') - 2); }
};

/// In alphabetical order; generated at build time from the files.
const std::vector<Kind>& kinds();

}  // namespace butee::app::init

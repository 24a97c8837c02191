#pragma once

#include <string>
#include <utility>

#include "butee/core/types.hpp"

namespace butee::embed {

/// The nodes and the degree of freedom of a selector of StructureOptions::forced: "string:all.uz"
/// is {"string:all", uz}; u if it does not end in the name of a degree of freedom ("beam@17.5").
inline std::pair<std::string, DofKind> split_forced(const std::string& selector) {
  const std::size_t point = selector.rfind('.');
  if (point == std::string::npos) return {selector, DofKind::u};
  const auto kind = dof_named(std::string_view(selector).substr(point + 1));
  if (!kind) return {selector, DofKind::u};
  return {selector.substr(0, point), *kind};
}

}  // namespace butee::embed

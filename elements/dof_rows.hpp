#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "butee/model/nodes.hpp"

namespace butee::elements {

/// Own nodes of an element are numbered below this.
inline constexpr model::NodeId kMostNodes = 5'000'000;

/// A row of the matrices: the selector of its node, or the index among the element's own nodes
/// (else -1).
struct DofRow {
  std::string node;
  model::NodeId own = -1;
  std::optional<DofKind> kind;
  std::string where;  ///< its line number
};

/// The rows of a file of DOFs, one node and degree of freedom per line: "17 uy", "shaft:last rz".
/// `name` is the element whose own nodes the file may name. Throws InputError ":3: what is wrong
/// there".
std::vector<DofRow> rows_in(std::string_view text, const std::string& name);

/// The largest index of an own node in a selector such as "NAME:17" or "NAME:0..48"; -1 if it
/// selects other nodes.
model::NodeId largest_own(const std::string& selector, const std::string& name);

}  // namespace butee::elements

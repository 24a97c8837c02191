#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "butee/model/nodes.hpp"

namespace butee::elements {

/// A row of the matrices: the selector of its node, or its number among the element's own nodes (else -1).
struct DofRow {
  std::string node;
  model::NodeId own = -1;
  std::optional<DofKind> kind;
  std::string where;  ///< the number of its line
};

/// The rows of a file of dofs, a node and a degree of freedom a line: "17 uy", "shaft:last rz". `name` is that of the
/// element whose own nodes they may be. Throws InputError ":3: what is wrong there".
std::vector<DofRow> rows_in(std::string_view text, const std::string& name);

/// The largest number of an own node in a selector such as "NAME:17" or "NAME:0..48"; -1 where it is of other nodes.
model::NodeId largest_own(const std::string& selector, const std::string& name);

}  // namespace butee::elements

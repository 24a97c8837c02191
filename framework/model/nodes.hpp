#pragma once

#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::model {

using NodeId = std::int32_t;

/// The nodes of one element: a chain with coordinates, or a lone node.
struct NodeGroup {
  std::string name;
  NodeId first = 0;
  std::vector<double> coordinates;  ///< m, along the beam; empty for a lone node
  /// Position in space: node i lies at origin + coordinates[i] direction, m.
  std::array<double, 3> origin{}, direction{1.0, 0.0, 0.0};

  bool lone() const { return coordinates.empty(); }
  NodeId size() const { return lone() ? 1 : static_cast<NodeId>(coordinates.size()); }
};

/// The nodes that a selector names, or the reason why it names none.
struct Selection {
  std::vector<NodeId> nodes;
  std::string problem;
  bool excused = false;  ///< the selector refers to an element whose error was reported already; `problem` is then
                         ///< empty
};

/// All nodes of a model by name. Nodes of several elements can be joined.
class BUTEE_EXPORT NodeTable {
 public:
  /// Adds a chain of nodes (a lone node if `coordinates` is empty) and returns the first.
  NodeId add(const std::string& name, std::vector<double> coordinates = {});

  /// Sets the position in space of the chain that `node` belongs to.
  void place(NodeId node, const std::array<double, 3>& origin, const std::array<double, 3>& direction);

  /// Makes two nodes one and the same.
  void join(NodeId a, NodeId b);

  /// The representative of `node` and all nodes joined to it.
  NodeId canonical(NodeId node) const;

  /// Marks a name whose element could not be read. An empty name excuses every unknown name.
  void excuse(const std::string& name) { excused_.insert(name); }

  /// `name`, `beam:first|last|middle|all`, `beam:17`, `beam:3..9`, `beam@17.5`.
  Selection select(std::string_view selector) const;

  NodeId size() const { return static_cast<NodeId>(root_.size()); }
  const NodeGroup* find(std::string_view name) const;
  const NodeGroup& group_of(NodeId node) const;
  /// "string:17" or "rotor".
  std::string name(NodeId node) const;
  std::vector<std::string> group_names() const;

 private:
  std::vector<NodeGroup> groups_;
  std::vector<NodeId> root_;
  std::set<std::string, std::less<>> excused_;
};

}  // namespace butee::model

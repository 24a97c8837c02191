#pragma once

#include <bit>
#include <string>
#include <vector>

#include "butee/model/nodes.hpp"

namespace butee::model {

/// One degree of freedom of one node.
struct NodalDof {
  NodeId node = 0;
  DofKind kind = DofKind::u;
};

/// A value on a degree of freedom: a force (N or N m), a displacement (m or rad), a velocity.
struct NodalValue {
  NodalDof dof;
  double value = 0.0;
};

/// The table of existing and fixed degrees of freedom and the numbers of the free ones.
///
/// A node has only the DOFs that some element claims. Joined nodes share their DOFs. Free DOFs are
/// numbered by node, and within a node in the order of DofKind.
class BUTEE_EXPORT DofTable {
 public:
  static constexpr Index kFixed = -1;
  static constexpr Index kAbsent = -2;

  explicit DofTable(const NodeTable& nodes);

  void claim(NodalDof dof, bool with_mass);
  void fix(NodalDof dof);
  void number();

  bool exists(NodalDof dof) const { return at(dof.node).exists & bit(dof.kind); }
  bool is_fixed(NodalDof dof) const { return at(dof.node).fixed & bit(dof.kind); }
  bool has_mass(NodalDof dof) const { return at(dof.node).with_mass & bit(dof.kind); }

  /// The number of a free DOF in the system, or kFixed, or kAbsent. Valid after number().
  Index index(NodalDof dof) const {
    const NodeEntry& node = at(dof.node);
    if (!(node.exists & bit(dof.kind))) return kAbsent;
    if (node.fixed & bit(dof.kind)) return kFixed;
    return node.first + std::popcount(static_cast<std::uint8_t>(node.exists & ~node.fixed & (bit(dof.kind) - 1U)));
  }
  Index free_count() const { return static_cast<Index>(free_.size()); }
  Index fixed_count() const { return fixed_count_; }
  const std::vector<NodalDof>& free() const { return free_; }
  /// "u of string:17"
  std::string name(NodalDof dof) const;

 private:
  /// Sets of DOF kinds as bits, and the number of the first free DOF.
  struct NodeEntry {
    std::uint8_t exists = 0, fixed = 0, with_mass = 0;
    std::int32_t first = 0;
  };

  static constexpr std::uint8_t bit(DofKind kind) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(kind));
  }
  const NodeEntry& at(NodeId node) const { return entries_[static_cast<std::size_t>(nodes_->canonical(node))]; }
  NodeEntry& at(NodeId node) { return entries_[static_cast<std::size_t>(nodes_->canonical(node))]; }

  const NodeTable* nodes_;
  std::vector<NodeEntry> entries_;
  std::vector<NodalDof> free_;
  Index fixed_count_ = 0;
};

/// The names that a scene may give to DOFs, for declarations of keys.
BUTEE_EXPORT std::vector<std::string> dof_names();

}  // namespace butee::model

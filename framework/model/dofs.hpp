#pragma once

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

/// Which degrees of freedom exist, which are fixed, and the numbers of the free ones.
///
/// A node has only the DOFs that some element claims. Joined nodes share theirs. Free DOFs are numbered by node, u
/// before theta.
class BUTEE_EXPORT DofTable {
 public:
  static constexpr Index kFixed = -1;
  static constexpr Index kAbsent = -2;

  explicit DofTable(const NodeTable& nodes);

  void claim(NodalDof dof, bool with_mass);
  void fix(NodalDof dof);
  void number();

  bool exists(NodalDof dof) const { return flags(dof) & kExists; }
  bool is_fixed(NodalDof dof) const { return flags(dof) & kIsFixed; }
  bool has_mass(NodalDof dof) const { return flags(dof) & kHasMass; }

  /// The number of a free DOF in the system, or kFixed, or kAbsent. After number().
  Index index(NodalDof dof) const { return numbers_[slot(dof)]; }
  Index free_count() const { return static_cast<Index>(free_.size()); }
  Index fixed_count() const { return fixed_count_; }
  const std::vector<NodalDof>& free() const { return free_; }
  /// "u of string:17"
  std::string name(NodalDof dof) const;

 private:
  enum Flag : std::uint8_t { kExists = 1, kHasMass = 2, kIsFixed = 4 };

  std::size_t slot(NodalDof dof) const {
    return 2 * static_cast<std::size_t>(nodes_->canonical(dof.node)) + (dof.kind == DofKind::theta ? 1 : 0);
  }
  std::uint8_t flags(NodalDof dof) const { return flags_[slot(dof)]; }

  const NodeTable* nodes_;
  std::vector<std::uint8_t> flags_;
  std::vector<std::int32_t> numbers_;
  std::vector<NodalDof> free_;
  Index fixed_count_ = 0;
};

}  // namespace butee::model

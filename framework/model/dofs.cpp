#include "butee/model/dofs.hpp"

namespace butee::model {

DofTable::DofTable(const NodeTable& nodes) : nodes_(&nodes), entries_(static_cast<std::size_t>(nodes.size())) {}

void DofTable::claim(NodalDof dof, bool with_mass) {
  NodeEntry& node = at(dof.node);
  node.exists |= bit(dof.kind);
  if (with_mass) node.with_mass |= bit(dof.kind);
}

void DofTable::fix(NodalDof dof) {
  at(dof.node).fixed |= bit(dof.kind);
}

void DofTable::number() {
  free_.clear();
  fixed_count_ = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    NodeEntry& node = entries_[i];
    node.first = static_cast<std::int32_t>(free_.size());
    fixed_count_ += std::popcount(static_cast<std::uint8_t>(node.exists & node.fixed));
    for (unsigned left = node.exists & ~unsigned{node.fixed}; left != 0; left &= left - 1)
      free_.push_back({static_cast<NodeId>(i), static_cast<DofKind>(std::countr_zero(left))});
  }
}

std::string DofTable::name(NodalDof dof) const {
  return std::string(name_of(dof.kind)) + " of " + nodes_->name(dof.node);
}

std::vector<std::string> dof_names() {
  return {kDofNames.begin(), kDofNames.end()};
}

}  // namespace butee::model

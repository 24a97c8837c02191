#include "butee/model/dofs.hpp"

namespace butee::model {

DofTable::DofTable(const NodeTable& nodes)
    : nodes_(&nodes), flags_(2 * static_cast<std::size_t>(nodes.size())), numbers_(flags_.size(), kAbsent) {}

void DofTable::claim(NodalDof dof, bool with_mass) {
  flags_[slot(dof)] |= kExists | (with_mass ? kHasMass : 0);
}

void DofTable::fix(NodalDof dof) {
  flags_[slot(dof)] |= kIsFixed;
}

void DofTable::number() {
  free_.clear();
  fixed_count_ = 0;
  for (std::size_t i = 0; i < flags_.size(); ++i) {
    numbers_[i] = kAbsent;
    if (!(flags_[i] & kExists)) continue;
    if (flags_[i] & kIsFixed) {
      numbers_[i] = kFixed;
      ++fixed_count_;
    } else {
      numbers_[i] = static_cast<std::int32_t>(free_.size());
      free_.push_back({static_cast<NodeId>(i / 2), i % 2 == 0 ? DofKind::u : DofKind::theta});
    }
  }
}

std::string DofTable::name(NodalDof dof) const {
  return std::string(name_of(dof.kind)) + " of " + nodes_->name(dof.node);
}

}  // namespace butee::model

#pragma once

#include "butee/model/element.hpp"

namespace butee::model {

/// Calls take(dofs, matrices, place) for each part of an element that contains one DOF; `place` is
/// the index of the DOF in it.
template <class Take>
class PartsAt final : public MatrixSink {
 public:
  PartsAt(const NodeTable& nodes, NodalDof dof, Take take, bool turns = false)
      : nodes_(nodes), node_(nodes.canonical(dof.node)), kind_(dof.kind), take_(std::move(take)), turns_(turns) {}

  bool turns() const override { return turns_; }

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (dofs[i].kind == kind_ && nodes_.canonical(dofs[i].node) == node_)
        take_(dofs, matrices, static_cast<Index>(i));
  }

 private:
  const NodeTable& nodes_;
  NodeId node_;
  DofKind kind_;
  Take take_;
  bool turns_;
};

}  // namespace butee::model

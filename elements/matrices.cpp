#include "elements/matrices.hpp"

#include <algorithm>

namespace butee::elements {

using model::NodalDof;

namespace {

/// The other displacement or rotation perpendicular to x, on which rotating damping also acts;
/// along x the kind itself.
DofKind across(DofKind kind) {
  const int axis = axis_of(kind);
  return axis == 0 ? kind : (is_rotation(kind) ? rotation_about : displacement_along)(3 - axis);
}

}  // namespace

Matrices::Matrices(std::vector<NodalDof> dofs, const SparseMatrix& mass, const SparseMatrix& stiffness,
                   const SparseMatrix& damping, const SparseMatrix& gyroscopic)
    : dofs_(std::move(dofs)), has_mass_(dofs_.size()), has_gyroscopic_(gyroscopic.nonZeros() > 0) {
  std::size_t kind = 0;
  for (const SparseMatrix* matrix : {&mass, &stiffness, &damping, &gyroscopic}) {
    for (Index j = 0; j < matrix->outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(*matrix, j); entry; ++entry) {
        const bool is_upper = entry.row() < j;
        pairs_.push_back({std::max<Index>(entry.row(), j), std::min<Index>(entry.row(), j)});
        pairs_.back().values[kind][is_upper ? 1 : 0] = entry.value();
      }
    ++kind;
  }
  const auto place = [](const Pair& pair) { return std::pair(pair.column, pair.row); };
  std::stable_sort(pairs_.begin(), pairs_.end(), [&](const Pair& a, const Pair& b) { return place(a) < place(b); });
  std::size_t last = 0;
  for (std::size_t i = 1; i < pairs_.size(); ++i) {
    if (place(pairs_[i]) != place(pairs_[last])) {
      pairs_[++last] = pairs_[i];
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t side = 0; side < 2; ++side) pairs_[last].values[k][side] += pairs_[i].values[k][side];
  }
  if (!pairs_.empty()) pairs_.resize(last + 1);
  for (const Pair& pair : pairs_)
    if (pair.row == pair.column) has_mass_[static_cast<std::size_t>(pair.row)] = pair.values[0][0] > 0.0;
}

void Matrices::claim(model::DofTable& dofs) const {
  for (std::size_t i = 0; i < dofs_.size(); ++i) dofs.claim(dofs_[i], has_mass_[i]);
}

void Matrices::assemble(model::MatrixSink& sink) const {
  const bool turns = sink.turns();
  for (const Pair& pair : pairs_) add(pair, turns, sink);
}

void Matrices::add(const Pair& pair, bool turns, model::MatrixSink& sink) const {
  std::vector<NodalDof> dofs = {dofs_[static_cast<std::size_t>(pair.row)]};
  if (pair.column != pair.row) dofs.push_back(dofs_[static_cast<std::size_t>(pair.column)]);
  const Index other = std::ssize(dofs) - 1;
  if (turns)
    for (Index i = 0; i <= other; ++i) {
      const NodalDof dof = dofs[static_cast<std::size_t>(i)], partner = {dof.node, across(dof.kind)};
      const auto same = [&](const NodalDof& one) { return one.node == partner.node && one.kind == partner.kind; };
      if (std::none_of(dofs.begin(), dofs.end(), same)) dofs.push_back(partner);
    }
  model::ElementMatrices matrices(std::ssize(dofs));
  if (turns) matrices.gyroscopic = matrices.mass;
  std::size_t kind = 0;
  for (Eigen::MatrixXd* matrix : {&matrices.mass, &matrices.stiffness, &matrices.damping, &matrices.gyroscopic}) {
    const auto& [lower, upper] = pair.values[kind++];
    if (matrix->size() == 0) continue;
    (*matrix)(0, other) = lower;
    if (other > 0) (*matrix)(other, 0) = upper;
  }
  sink.add(dofs, matrices);
}

}  // namespace butee::elements

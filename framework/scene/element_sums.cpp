#include "butee/scene/element_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace butee::scene {

ElementSums::ElementSums(const model::DofTable& dofs)
    : dofs_(dofs), sums_(static_cast<std::size_t>(dofs.free_count())) {}

void ElementSums::add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) {
  // A stiffness below this part of the largest of its kind in the part, such as across an inclined bar, is rounding.
  constexpr double kRounding = 1e-10;
  // Matrices of the wrong size are refused where the system is assembled.
  const auto n = static_cast<Index>(dofs.size());
  if (matrices.mass.rows() != n || matrices.stiffness.rows() != n || matrices.damping.rows() != n) return;
  if (!matrices.mass.allFinite() || !matrices.stiffness.allFinite() || !matrices.damping.allFinite()) {
    if (not_finite_.empty() || not_finite_.back() != element_) not_finite_.push_back(element_);
    return;
  }
  std::array<double, 2> largest{};
  for (Index i = 0; i < n; ++i) {
    double& of_kind = largest[is_rotation(dofs[static_cast<std::size_t>(i)].kind) ? 1 : 0];
    of_kind = std::max(of_kind, matrices.stiffness(i, i));
  }
  for (Index i = 0; i < n; ++i) {
    const model::NodalDof dof = dofs[static_cast<std::size_t>(i)];
    const Index at = dofs_.index(dof);
    if (at < 0) continue;
    Sum& sum = sums_[static_cast<std::size_t>(at)];
    const double stiffness = matrices.stiffness(i, i), damping = matrices.damping(i, i);
    sum.mass += matrices.mass(i, i);
    sum.stiffness += stiffness;
    sum.damping += damping;
    if (stiffness > sum.stiffest.value) sum.stiffest = {stiffness, element_};
    if (damping > sum.most_damped.value) sum.most_damped = {damping, element_};
    if (stiffness > kRounding * largest[is_rotation(dof.kind) ? 1 : 0] &&
        (sum.softest.value == 0.0 || stiffness < sum.softest.value))
      sum.softest = {stiffness, element_};
  }
}

}  // namespace butee::scene

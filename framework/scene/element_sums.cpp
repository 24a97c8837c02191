#include "butee/scene/element_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "butee/model/matrix_collector.hpp"

namespace butee::scene {

ElementSums::ElementSums(const model::DofTable& dofs)
    : dofs_(dofs), sums_(static_cast<std::size_t>(dofs.free_count())) {}

void ElementSums::add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) {
  // A stiffness below this part of the largest of its kind in the part, such as across an inclined bar, is rounding.
  constexpr double kRounding = 1e-10;
  if (const std::string complaint = model::complaint_about(matrices, dofs, dofs_); !complaint.empty()) {
    complaints_.emplace(element_, complaint);
    return;
  }
  const auto n = static_cast<Index>(dofs.size());
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

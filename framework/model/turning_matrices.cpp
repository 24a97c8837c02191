#include "butee/model/turning_matrices.hpp"

namespace butee::model {

Eigen::MatrixXd circulatory_of(std::span<const NodalDof> dofs, const Eigen::MatrixXd& damping) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(damping.rows(), damping.cols());
  for (std::size_t j = 0; j < dofs.size(); ++j) {
    const bool along_y = axis_of(dofs[j].kind) == 1;
    if (axis_of(dofs[j].kind) == 0) continue;
    const int other = is_rotation(dofs[j].kind) ? 3 : 0;
    const NodalDof partner{dofs[j].node, static_cast<DofKind>(other + (along_y ? 2 : 1))};
    for (std::size_t k = 0; k < dofs.size(); ++k)
      if (dofs[k].node == partner.node && dofs[k].kind == partner.kind)
        result.col(static_cast<Index>(j)) = (along_y ? -1.0 : 1.0) * damping.col(static_cast<Index>(k));
  }
  return result;
}

Eigen::MatrixXd rotating_damping_of(const ElementMatrices& matrices, double proportional) {
  return matrices.rotating_damping.size() > 0 ? matrices.rotating_damping
                                              : Eigen::MatrixXd(proportional * matrices.stiffness);
}

}  // namespace butee::model

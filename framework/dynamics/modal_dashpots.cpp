#include "butee/dynamics/modal_dashpots.hpp"

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_damping.hpp"

namespace butee::dynamics {
namespace {

/// The matrix with a full sparse pattern.
SparseMatrix with_all_places(const Eigen::MatrixXd& matrix) {
  SparseMatrix full(matrix.rows(), matrix.cols());
  full.reserve(Eigen::VectorXi::Constant(matrix.cols(), static_cast<int>(matrix.rows())));
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i < matrix.rows(); ++i) full.insert(i, j) = matrix(i, j);
  full.makeCompressed();
  return full;
}

}  // namespace

model::System assemble_to_run(const model::Model& model) {
  model::System system = assemble(model);
  if (!system.damping.is_modal() || system.is_symmetric) return system;
  if (system.size() > kMostModalDashpots)
    throw InputError(
        "damping.modal: if shafts turn, or bearings or given matrices have cross terms, systems of more than " +
        std::to_string(kMostModalDashpots) + " free DOFs (this one has " + std::to_string(system.size()) +
        ") cannot have modal damping, whose matrix is dense; give mass_proportional and stiffness_proportional");
  model::System rest = assemble(model, model::TurningParts::apart);
  rest.stiffness = SparseMatrix(0.5 * (rest.stiffness + SparseMatrix(rest.stiffness.transpose())));
  rest.is_symmetric = rest.stiffness_is_symmetric = true;
  Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(system.size(), system.size());
  if (const auto modal = ModalDamping::of(rest)) damping = modal->factor() * modal->factor().transpose();
  if (system.dashpots.size() > 0) damping += Eigen::MatrixXd(system.dashpots);
  system.dashpots = with_all_places(damping);
  for (SparseMatrix* matrix : {&system.mass, &system.stiffness, &system.gyroscopic, &system.circulatory})
    if (matrix->size() > 0) *matrix = with_all_places(Eigen::MatrixXd(*matrix));
  system.damping.every_mode = 0.0;
  system.damping.lowest_modes.clear();
  return system;
}

}  // namespace butee::dynamics

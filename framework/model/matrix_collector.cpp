#include "butee/model/matrix_collector.hpp"

#include <cmath>

#include "butee/core/error.hpp"
#include "butee/model/turning_matrices.hpp"

namespace butee::model {
namespace {

/// Differences between a(i, j) and a(j, i) up to this fraction of them are rounding.
constexpr double kAsymmetry = 1e-12;

/// a(i, j) = sign a(j, i)
bool is_symmetric(const Eigen::MatrixXd& matrix, double sign = 1.0) {
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i <= j; ++i) {
      const double a = matrix(i, j), b = sign * matrix(j, i);
      if (a != b && !(std::abs(a - b) <= kAsymmetry * (std::abs(a) + std::abs(b)))) return false;
    }
  return true;
}

SparseMatrix built(Index n, std::vector<Eigen::Triplet<double>>& triplets) {
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  triplets = {};
  return matrix;
}

}  // namespace

std::string complaint_about(const ElementMatrices& matrices, std::span<const NodalDof> dofs, const DofTable& table) {
  const auto n = static_cast<Index>(dofs.size());
  if (n == 0) return "it adds matrices without DOFs";
  std::vector<const Eigen::MatrixXd*> given = {&matrices.mass, &matrices.stiffness, &matrices.damping};
  for (const Eigen::MatrixXd* matrix : {&matrices.gyroscopic, &matrices.rotating_damping})
    if (matrix->size() > 0) given.push_back(matrix);
  for (const Eigen::MatrixXd* matrix : given)
    if (matrix->rows() != n || matrix->cols() != n)
      return "it adds a matrix of " + std::to_string(matrix->rows()) + " x " + std::to_string(matrix->cols()) +
             " for " + std::to_string(n) + " DOFs";
  for (const Eigen::MatrixXd* matrix : given)
    if (!matrix->allFinite())
      return "its matrices have entries that are not finite: check its lengths, section and material, in SI units";
  for (Index i = 0; i < n; ++i) {
    const NodalDof dof = dofs[static_cast<std::size_t>(i)];
    if (table.exists(dof)) continue;
    // A lumped mass has inertia along all axes and claims only those that other elements use.
    for (const Eigen::MatrixXd* matrix : {&matrices.stiffness, &matrices.damping})
      if (!matrix->row(i).isZero(0.0) || !matrix->col(i).isZero(0.0))
        return "it acts on " + table.name(dof) + ", which no element has claimed: its claim() must name all its DOFs";
  }
  if (!is_symmetric(matrices.mass)) return "its mass matrix is not symmetric";
  if (matrices.gyroscopic.size() > 0 && !is_symmetric(matrices.gyroscopic, -1.0))
    return "its gyroscopic matrix is not skew-symmetric: gyroscopic moments do no work";
  return "";
}

SparseMatrix MatrixCollector::Entries::build(Index n) {
  return is_used_ ? built(n, triplets_) : SparseMatrix();
}

template <class Visit>
void MatrixCollector::visit(std::span<const NodalDof> dofs, Visit entry) const {
  for (std::size_t j = 0; j < dofs.size(); ++j) {
    const Index column = dofs_.index(dofs[j]);
    if (column < 0) continue;
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const Index row = dofs_.index(dofs[i]); row >= 0)
        entry(static_cast<int>(row), static_cast<int>(column), static_cast<Index>(i), static_cast<Index>(j));
  }
}

void MatrixCollector::add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) {
  if (const std::string wrong = complaint_about(matrices, dofs, dofs_); !wrong.empty())
    throw InputError("an element" + (dofs.empty() ? "" : " on " + dofs_.name(dofs.front())) + ": " + wrong);
  stiffness_is_symmetric_ = stiffness_is_symmetric_ && is_symmetric(matrices.stiffness);
  damping_is_symmetric_ = damping_is_symmetric_ && is_symmetric(matrices.damping);
  if (turns_) return add_turning(dofs, matrices);
  visit(dofs, [&](int row, int column, Index p, Index q) {
    add_entry(row, column, matrices.mass(p, q), matrices.stiffness(p, q), matrices.damping(p, q));
  });
}

void MatrixCollector::add_turning(std::span<const NodalDof> dofs, const ElementMatrices& matrices) {
  const auto size = matrices.mass.rows();
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(size, size);
  const Eigen::MatrixXd turning = rotating_damping_of(matrices, rotating_damping_);
  const Eigen::MatrixXd circulatory = circulatory_of(dofs, turning);
  const Eigen::MatrixXd& gyroscopic = matrices.gyroscopic.size() > 0 ? matrices.gyroscopic : none;
  visit(dofs, [&](int row, int column, Index p, Index q) {
    add_entry(row, column, matrices.mass(p, q), matrices.stiffness(p, q), matrices.damping(p, q) + turning(p, q),
              gyroscopic(p, q), circulatory(p, q));
  });
}

void MatrixCollector::build(System& system) {
  const Index n = dofs_.free_count();
  system.dashpots = dashpots_.build(n);
  system.gyroscopic = gyroscopic_.build(n);
  system.circulatory = circulatory_.build(n);
  system.stiffness = built(n, stiffness_);
  system.mass = built(n, mass_);
  system.stiffness_is_symmetric = stiffness_is_symmetric_;
  system.is_symmetric = stiffness_is_symmetric_ && damping_is_symmetric_;
}

}  // namespace butee::model

#include "butee/dynamics/natural_matrices.hpp"

#include <limits>

#include "butee/core/error.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/slow_modes.hpp"
#include "butee/linalg/dense_pairs.hpp"

namespace butee::dynamics {
namespace {

/// Squares of frequencies between 0 and minus this fraction of the highest are rounding.
constexpr double kRoundingOfSquares = 1e-11;
/// Sets the entries of S^T A S that are rounding of its products to 0, for example those of rigid
/// motion, on which dashpots between parts do not act. `sizes` holds |A|.
void clear_rounding(const SparseMatrix& sizes, const Eigen::MatrixXd& shapes, Eigen::MatrixXd& product) {
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const Eigen::MatrixXd shape_sizes = shapes.cwiseAbs(), forces = sizes * shape_sizes;
  const Eigen::MatrixXd bound = kRounding * (shape_sizes.transpose() * forces);
  product = (product.cwiseAbs().array() > bound.array()).select(product, 0.0);
}

}  // namespace

NaturalMatrices natural_matrices(Dynamics& dynamics, double speed, double run_time) {
  const model::System& system = dynamics.system();
  const Index n = system.size();
  SparseMatrix elastic = system.stiffness;
  if (system.rotation != nullptr && system.circulatory.size() > 0) elastic += speed * system.circulatory;
  SparseMatrix transposed = elastic.transpose();
  SparseMatrix even = 0.5 * (elastic + transposed);
  auto natural = linalg::dense_pairs(even, system.mass);
  if (!natural) throw InputError("integrator.type: the modes could not be computed");
  Eigen::MatrixXd& shapes = natural->vectors;

  const Index rigid = count_rigid(natural->values, run_time);
  Eigen::MatrixXd damping(n, n), stiffness = Eigen::MatrixXd::Zero(n, n);
  if (dynamics.has_damping() || system.rotation != nullptr) {
    Eigen::MatrixXd forces(n, n);
    for (Index j = 0; j < n; ++j) dynamics.damping_force(shapes.col(j), forces.col(j));
    damping.noalias() = shapes.transpose() * forces;
    if (system.dashpots.size() > 0 || system.rotation != nullptr) {
      SparseMatrix sizes = system.damping.mass_proportional * system.mass.cwiseAbs();
      sizes += system.damping.stiffness_proportional * system.stiffness.cwiseAbs();
      if (system.dashpots.size() > 0) sizes += system.dashpots.cwiseAbs();
      if (system.gyroscopic.size() > 0) sizes += std::abs(speed) * system.gyroscopic.cwiseAbs();
      clear_rounding(sizes, shapes, damping);
      if (separate_rigid(rigid, run_time, shapes, damping)) clear_rounding(sizes, shapes, damping);
    }
  } else {
    damping.setZero();
  }
  if (!system.stiffness_is_symmetric || system.circulatory.size() > 0) {
    SparseMatrix odd = 0.5 * (elastic - transposed);
    stiffness.noalias() = shapes.transpose() * (odd * shapes);
    clear_rounding(odd.cwiseAbs(), shapes, stiffness);
  }
  const Index soft = std::max(rigid, count_soft(natural->values, natural->values[n - 1]));
  stiffness.topLeftCorner(soft, soft) += SoftStiffness(even, system, run_time).of(soft, shapes);
  // Values below 0 are rounding, or those of a structure that is unstable without damping and bearings.
  const double rounding = kRoundingOfSquares * std::abs(natural->values[n - 1]);
  Vector squares = natural->values;
  squares.head(soft).setZero();
  squares = (squares.array() < 0.0 && squares.array() > -rounding).select(0.0, squares);
  return {std::move(natural->vectors), std::move(damping), std::move(stiffness), std::move(squares)};
}

}  // namespace butee::dynamics

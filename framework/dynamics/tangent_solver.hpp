#pragma once

#include <Eigen/LU>

#include "butee/dynamics/effective_solver.hpp"
#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {

/// Solves effective equations with the tangents of obstacles beside the stops,
///
///     (A + sum_i S_i^T B_i S_i) x = b,    B_i = velocity_factor C_i + displacement_factor K_i,    x = y - Z (1 + B
///     G)^-1 B S y, A y = b,    Z = A^-1 S^T,    G = S Z
///
/// where A is what an EffectiveSolver solves and the sum goes over the obstacles that exert a force: two solves for
/// each in set(). B need not be symmetric. Checked against a full factorization in tests/unit/obstacles_test.cpp.
class BUTEE_EXPORT TangentSolver {
 public:
  /// Both must outlive it; `obstacles` is null where there are none.
  TangentSolver(EffectiveSolver& effective, const Obstacles* obstacles)
      : effective_(effective), obstacles_(obstacles) {}

  /// Takes A, by the factors and stops given, and the tangents. False where A is not positive definite or the sum is
  /// singular.
  [[nodiscard]] bool set(double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                         std::span<const Obstacles::Tangent> tangents);
  /// b := x
  [[nodiscard]] bool solve(VectorRef b);

 private:
  /// B_i S_i y
  Obstacles::Coordinates along(Index i, ConstVectorRef y) const;

  EffectiveSolver& effective_;
  const Obstacles* obstacles_;
  Vector kappa_;
  std::vector<Index> contacts_;
  std::vector<Obstacles::Block> blocks_;
  Index width_ = 2;         ///< coordinates of a contact that are in use
  Eigen::MatrixXd motion_;  ///< Z
  Eigen::PartialPivLU<Eigen::MatrixXd> small_;
  Vector right_;
};

}  // namespace butee::dynamics

#pragma once

#include <optional>

#include <Eigen/LU>

#include "butee/dynamics/effective_solver.hpp"
#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {

/// True if the damping force of a contact has an infinite derivative at g = 0, as for the dashpot
/// `jankowski` and some laws from modules: methods that take tangents cannot treat it.
BUTEE_EXPORT bool has_infinite_slope(const Obstacles& obstacles);

/// Solves effective equations with the tangents of obstacles in addition to the stops:
///
///     (A + sum_i S_i^T B_i S_i) x = b,    B_i = velocity_factor C_i + displacement_factor K_i,    x = y - Z (1 + B
///     G)^-1 B S y, A y = b,    Z = A^-1 S^T,    G = S Z
///
/// where A is the matrix of an EffectiveSolver and the sum is over the obstacles that exert a
/// force. set() takes two solves for each; if more than kMostLocal exert one, it factorizes the whole matrix instead
/// (not with modal damping, whose matrix is not sparse). B need not be symmetric. Checked against a full
/// factorization in tests/unit/obstacles_test.cpp.
class BUTEE_EXPORT TangentSolver {
 public:
  /// Both must outlive this object; `obstacles` is null if there are none.
  TangentSolver(EffectiveSolver& effective, const Obstacles* obstacles)
      : effective_(effective), obstacles_(obstacles) {}

  /// Sets A, by the given factors and stop stiffnesses, and the tangents. False if A is not
  /// positive definite or the sum is singular.
  [[nodiscard]] bool set(double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                         std::span<const Obstacles::Tangent> tangents);
  /// b := x
  [[nodiscard]] bool solve(VectorRef b);
  /// force += K_t y with the stiffnesses of set(), those of `stops` included; `work` has one entry for each stop.
  void add_stiffness(const ElasticStops& stops, ConstVectorRef y, VectorRef work, VectorRef force) const;

 private:
  /// The largest number of contacts that are solved by two solves each (chosen).
  static constexpr std::size_t kMostLocal = 32;

  bool factorize_whole(ConstVectorRef kappa);
  /// B_i S_i y
  Obstacles::Coordinates along(Index i, ConstVectorRef y) const;

  EffectiveSolver& effective_;
  const Obstacles* obstacles_;
  Vector kappa_;
  std::vector<Index> contacts_;
  std::vector<Obstacles::Block> blocks_, stiffness_;  ///< B_i and K_i
  Index width_ = 2;                                   ///< number of coordinates of a contact that are in use
  Eigen::MatrixXd motion_;                            ///< Z
  Eigen::PartialPivLU<Eigen::MatrixXd> small_;
  Vector right_;
  SparseMatrix whole_;  ///< A + sum_i S_i^T B_i S_i, with the places of all contacts
  std::optional<linalg::LinearSolver> whole_solver_;
  bool is_whole_ = false;  ///< whole_solver_ holds the matrix of set()
};

}  // namespace butee::dynamics

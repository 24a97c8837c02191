#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "butee/dynamics/obstacles.hpp"
#include "butee/linalg/linear_solver.hpp"

namespace butee::dynamics {

/// The forces that hold the contacts that stick rigidly: T v = b(t) with a row of T for each.
/// M^-1 T^T and T M^-1 T^T are kept until another set of contacts sticks. The rows must be independent: the force on
/// contacts that hold the same motion could be divided between them in more than one way.
class RigidSticks {
 public:
  /// `obstacles` must outlive this object.
  explicit RigidSticks(Obstacles& obstacles) : obstacles_(obstacles) {}

  /// Throws InputError if friction supports, which may all stick at once, depend on each other.
  void check_supports(linalg::LinearSolver& mass);

  /// a += M^-1 T^T times the forces that keep T a = db/dt at t. Without t, `a` is a derivative of the acceleration:
  /// db/dt is constant between the instants at which the speed of rotation bends.
  void hold(std::optional<double> t, linalg::LinearSolver& mass, VectorRef a);
  /// v += M^-1 T^T times the impulses that give T v = b
  void stop(double t, linalg::LinearSolver& mass, VectorRef v);
  /// The forces of the last hold() since clear(), N, in the order of Obstacles::rigid_sticks().
  const Vector& forces() const { return force_; }
  void clear() { force_.resize(0); }

 private:
  /// Updates the matrices to the contacts that stick now; false if none does. Throws RunError if they depend on each
  /// other.
  bool prepare(linalg::LinearSolver& mass);
  void assemble(linalg::LinearSolver& mass);
  /// Names a contact that holds only what the others hold; "" if there is none.
  std::string redundant() const;
  void solve(VectorRef y);

  Obstacles& obstacles_;
  std::vector<Index> contacts_;
  Eigen::MatrixXd motion_, compliance_;  ///< M^-1 T^T and T M^-1 T^T
  Eigen::LLT<Eigen::MatrixXd> factor_;   ///< of T M^-1 T^T
  Vector force_;
};

}  // namespace butee::dynamics

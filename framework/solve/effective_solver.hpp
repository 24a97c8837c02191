#pragma once

#include <array>
#include <vector>

#include "butee/solve/contact.hpp"
#include "butee/solve/symmetric_factor.hpp"

namespace butee::solve {

/// Solves the effective equations of an implicit method,
///
///     (M + c C + k (K + S^T diag(kappa) S)) y = b,     C = c_m M + c_k K + D
///
/// with the feedback factors c (s) and k (s2) of the method (gamma h and beta h^2 for Newmark) and the stiffnesses
/// kappa (N/m) of the stops, zero where open. The result is a function of (system, c, k, kappa) alone.
class BUTEE_EXPORT EffectiveSolver {
 public:
  /// `system` and `counters` must outlive it; `contact` is of the same system.
  EffectiveSolver(const model::System& system, const Contact& contact, Counters& counters);

  /// Sets the feedback factors; work is done only where they change.
  void set_factors(double damping, double stiffness);

  /// b := y. `kappa` has an entry per stop. False where the matrix is not positive definite.
  [[nodiscard]] bool solve(ConstVectorRef kappa, VectorRef b);

 private:
  void locate_stops(const Contact& contact);

  const model::System& system_;
  double damping_factor_ = -1.0, stiffness_factor_ = -1.0;
  SparseMatrix base_;       ///< M + c C + k K
  SparseMatrix effective_;  ///< with the stops
  SymmetricFactor factor_;
  bool has_stops_;
  bool factorized_ = false;
  /// Places of stop i in the value array: (a,a), (b,b), (a,b), (b,a), -1 where an end is fixed.
  std::vector<std::array<Index, 4>> places_;
};

}  // namespace butee::solve

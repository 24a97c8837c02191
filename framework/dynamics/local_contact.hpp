#pragma once

#include <vector>

#include "butee/dynamics/elastic_stops.hpp"
#include "butee/linalg/linear_solver.hpp"

namespace butee::dynamics {

/// Corrects a solution of A_0 y = b for the stiffness of the stops, without a factorization of
/// system size:
///
///     (A_0 + k S^T diag(kappa) S) x = b,    x = y - k W q,    q = kappa z,    z = S y - k G q,
///     W = A_0^-1 S^T,    G = S A_0^-1 S^T
///
/// Near stops (k kappa_i sum_j |G_ij| > 1e-3: closed or nearly closed) are solved by a small dense
/// Cholesky factorization. The tiny stiffnesses that open stops of a regularised law keep are
/// solved by sweeps in stop space, to rounding; those that would change x by less than 1e-11 are
/// omitted. Checked against a full factorization in tests/unit/solver_test.cpp.
class BUTEE_EXPORT LocalContact {
 public:
  /// With more stops than this a full factorization of a sparse system is faster.
  static constexpr Index kMostStops = 256;

  explicit LocalContact(const ElasticStops& contact);
  LocalContact(const LocalContact&) = delete;
  LocalContact& operator=(const LocalContact&) = delete;

  /// Sets a new A_0: computes G, and W if the system is small.
  void set_base(linalg::LinearSolver& base);

  /// Corrects in place: y := x. `stiffness_factor` is k. False if the small system is not positive
  /// definite.
  [[nodiscard]] bool correct(linalg::LinearSolver& base, double stiffness_factor, ConstVectorRef kappa, VectorRef y);

 private:
  bool find_forces(double k, ConstVectorRef kappa);
  void divide(double k, ConstVectorRef kappa);
  bool factorize_near(double k, ConstVectorRef kappa);
  void solve_near(double k);
  /// Updates force_ of the far stops, given near_ and sum_ = G (far forces) so far; adds the near
  /// stops' contribution to sum_.
  void update_far(double k, ConstVectorRef kappa);
  /// sum_ := G force_ of the far stops, and work_ := W force_ if W is kept.
  void spread_far();
  void apply(linalg::LinearSolver& base, double k, VectorRef y);

  const ElasticStops& contact_;
  Eigen::MatrixXd compliance_;            ///< G, m x m
  linalg::DenseProduct fast_compliance_;  ///< the same, for few stops
  linalg::DenseProduct influence_;        ///< W, n x m, or empty
  Vector row_sums_;                       ///< row sums of |G|
  Eigen::MatrixXd near_matrix_;           ///< G_NN + diag(1/(k kappa_N)) and its factor
  Vector free_, force_, sum_, near_, work_;
  Vector contraction_bound_;  ///< k kappa_i sum_j |G_ij| of every stop
  std::vector<Index> near_places_, far_places_, all_places_;
  std::span<const Index> near_stops_, far_stops_;  ///< the stops of this solve, within the arrays above
  bool far_is_spread_ = false;                     ///< work_ holds the contribution of the far forces
  double contraction_ = 0.0;                       ///< of a sweep over the far stops: their largest bound
};

}  // namespace butee::dynamics

#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// A stop with a piecewise linear law. While closed it exerts F = -side (k g + c g') with w = x_a -
/// x_b, g = side w - gap.
struct LinearStop {
  Index a, b;                          ///< free DOFs of w = x_a - x_b; negative: fixed
  double gap, stiffness, damping = 0;  ///< m, N/m, N s/m
  bool positive = true, negative = true;
  bool always_closed = false;  ///< no gap on either side: the stop is a spring
  bool pulls = false;          ///< with damping: true: opens at g = 0; false: at F = 0

  double displacement(const double* x) const { return (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0); }
};

/// A system of few DOFs with dense matrices: M a + C v + K x = F(t) + F_c with piecewise linear
/// stops. Loads are harmonic, or parabolas in time between discontinuities.
class SmallSystem {
 public:
  static constexpr Index kMostDofs = 24;

  /// Throws InputError for any other system; the message names suitable methods. `dynamics` must
  /// outlive it.
  explicit SmallSystem(dynamics::Dynamics& dynamics);
  /// The reason why a scene is not supported; empty if it is.
  static std::string obstacle_to(dynamics::Dynamics& dynamics);

  Index size() const { return mass.rows(); }
  Index stop_count() const { return static_cast<Index>(stops.size()); }
  Index harmonic_count() const { return static_cast<Index>(frequencies.size()); }
  /// The polynomial part of the loads just after `t`: to column k of `force` (3 columns, a row for
  /// each DOF, and more) adds the coefficient of (t' - t)^k, N/s^k. False if it is zero.
  bool add_polynomials(double t, Eigen::MatrixXd& force) const;

  LongMatrix mass, damping, stiffness;  ///< n x n, with all stops open
  std::vector<LinearStop> stops;        ///< those of dynamics::ElasticStops first, then those with dissipation
  std::vector<double> frequencies;      ///< distinct frequencies of the harmonic loads, rad/s
  LongMatrix cosine, sine;              ///< n x number of frequencies: F = cosine cos(W t) + sine sin(W t)

 private:
  void add_loads(const model::System& system);
  void add_stops(dynamics::Dynamics& dynamics);

  std::vector<const model::FreeLoad*> others_;  ///< loads that are no harmonics
};

}  // namespace butee::integrators

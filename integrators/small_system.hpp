#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// A stop with a piecewise linear law: F = -side (k g + c g') at w = row . x, g = side w - gap, while it is closed.
struct LinearStop {
  Index a, b;                          ///< free DOFs of w = x_a - x_b, negative where fixed
  double gap, stiffness, damping = 0;  ///< m, N/m, N s/m
  bool positive = true, negative = true;
  bool always_closed = false;  ///< no gap on either side: a spring
  bool pulls = false;          ///< with damping: opens at g = 0, else at F = 0

  double displacement(const double* x) const { return (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0); }
};

/// A system of few DOFs in dense matrices: M a + C v + K x = F(t) + F_c with piecewise linear stops and loads that are
/// harmonic or parabolas in time between discontinuities.
class SmallSystem {
 public:
  static constexpr Index kMostDofs = 24;

  /// Throws InputError, which names methods that can, for all else. `dynamics` must outlive it.
  explicit SmallSystem(dynamics::Dynamics& dynamics);
  /// Why a scene cannot be taken; empty where it can.
  static std::string obstacle_to(dynamics::Dynamics& dynamics);

  Index size() const { return mass.rows(); }
  Index stop_count() const { return static_cast<Index>(stops.size()); }
  Index harmonic_count() const { return static_cast<Index>(frequencies.size()); }
  /// The polynomial part of the loads: column k of `force` (n x 3) := the coefficient of (t' - t)^k, N/s^k, from the
  /// right at `t`. False where it is zero.
  bool add_polynomials(double t, Eigen::MatrixXd& force) const;

  LongMatrix mass, damping, stiffness;  ///< n x n; stops open
  std::vector<LinearStop> stops;        ///< those of Contact first, then those with dissipation
  std::vector<double> frequencies;      ///< rad/s, of the harmonic loads, each once
  LongMatrix cosine, sine;              ///< n x frequencies: F = cosine cos(W t) + sine sin(W t)

 private:
  void add_loads(const model::System& system);
  void add_stops(dynamics::Dynamics& dynamics);

  struct OtherLoad {
    const model::FreeLoad* load;
  };
  std::vector<OtherLoad> others_;
};

}  // namespace butee::integrators

#pragma once

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// Parts that turn at a varying speed Omega(t) add to K and D, at an instant,
///
///     K: Omega W + Omega' G,    D: Omega G - c_k (Omega W + Omega' G)
///
/// so that C = c_m M + c_k K + D holds no more of it than Omega G, Rayleigh damping being proportional to the K of
/// rest.
class BUTEE_EXPORT Turning {
 public:
  /// `system`, whose rotation is set, must outlive it.
  explicit Turning(const model::System& system);

  /// Takes the speed at `t`, s.
  void set_time(double t);
  /// Counts the instants whose speed or acceleration differed from those of the one before.
  int revision() const { return revision_; }

  /// y -= its part of K x + velocity_factor D v
  void subtract_forces(const double* x, double velocity_factor, ConstVectorRef v, VectorRef y) const;
  /// y += its part of C v
  void add_damping_force(ConstVectorRef v, VectorRef y) const;
  /// y += its part of K x
  void add_elastic_force(ConstVectorRef x, VectorRef y) const;
  /// y -= dC/dt v + dK/dt x
  void subtract_rate(ConstVectorRef x, ConstVectorRef v, VectorRef y) const;
  /// `matrix`, of the system's pattern, += its part of on_d D + on_k K
  void add_to(double on_d, double on_k, SparseMatrix& matrix) const;

 private:
  const model::System& system_;
  double time_, speed_ = 0.0, acceleration_ = 0.0;
  int revision_ = 0;
};

}  // namespace butee::dynamics

#pragma once

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The terms of K and D from parts that turn at a varying speed Omega(t), at an instant:
///
///     K: Omega W + Omega' G,    D: Omega G - c_k (Omega W + Omega' G)
///
/// The terms of D are such that C = c_m M + c_k K + D contains only Omega G of them, since Rayleigh
/// damping is proportional to the K at rest.
class BUTEE_EXPORT Turning {
 public:
  /// `system`, whose rotation must be set, must outlive this object.
  explicit Turning(const model::System& system);

  /// Sets the speed and acceleration to those at `t`, s.
  void set_time(double t);
  /// The number of instants whose speed or acceleration differed from those of the previous one.
  int revision() const { return revision_; }

  /// y -= turning part of K x + velocity_factor D v
  void subtract_forces(const double* x, double velocity_factor, ConstVectorRef v, VectorRef y) const;
  /// y += turning part of C v
  void add_damping_force(ConstVectorRef v, VectorRef y) const;
  /// y += turning part of K x
  void add_elastic_force(ConstVectorRef x, VectorRef y) const;
  /// y -= dC/dt v + dK/dt x
  void subtract_rate(ConstVectorRef x, ConstVectorRef v, VectorRef y) const;
  /// `matrix`, with the system's pattern, += turning part of on_d D + on_k K
  void add_to(double on_d, double on_k, SparseMatrix& matrix) const;

 private:
  const model::System& system_;
  double time_, speed_ = 0.0, acceleration_ = 0.0;
  int revision_ = 0;
};

}  // namespace butee::dynamics

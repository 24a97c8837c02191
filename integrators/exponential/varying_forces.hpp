#pragma once

#include <vector>

#include "butee/model/system.hpp"

namespace butee::integrators {

/// Forces beside those of contacts that collocation evaluates at the nodes of a step: of unbalances whose speed varies,
/// and of turning parts, as far as they differ from those at the reference speed Omega_r of the modes,
///
///     -(Omega - Omega_r) (G v + W x) - Omega' G x
///
/// See dynamics::Turning for G and W, and plugins/exponential/COLLOCATION.md, section 3.
class VaryingForces {
 public:
  /// `system` must outlive it.
  VaryingForces(const model::System& system, double reference_speed);

  /// True for a load that add() contains.
  static bool contains(const model::FreeLoad& load);

  /// The DOFs on which the forces act or depend, ascending; empty if there are none.
  const std::vector<Index>& dofs() const { return dofs_; }
  bool need_velocity() const { return system_.rotation != nullptr; }
  /// The highest frequency of the unbalances, rad/s; 0 without one.
  double highest_frequency() const { return highest_frequency_; }

  /// force += the forces at time t
  void add(double t, const Vector& x, const Vector& v, Vector& force);

 private:
  const model::System& system_;
  double reference_speed_, highest_frequency_ = 0.0;
  std::vector<const model::FreeLoad*> unbalances_;
  std::vector<Index> dofs_;
  Vector work_;
};

}  // namespace butee::integrators

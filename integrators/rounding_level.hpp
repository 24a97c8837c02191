#pragma once

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// The scales below which errors of a step are rounding, which shorter steps do not reduce: those of components that
/// move by the rounding of others only, and those of forces in balance. integrators/error-control.md, "Rounding".
class RoundingLevel {
 public:
  /// `dynamics` must outlive it. `rate`: the highest rate of a DOF with all stops closed, 1/s.
  RoundingLevel(dynamics::Dynamics& dynamics, double tolerance, double rate);

  /// Raises the scales of displacements and velocities so that an error of rounding in the step from `from` to `to` of
  /// length h, s, is at most the fraction `bound` of them, in any component. `stable`: the longest step in which no
  /// motion grows; beyond half of it errors may be such growth and not rounding.
  void raise(const time::State& from, const time::State& to, double h, double stable, double bound, Vector& scale_x,
             Vector& scale_v);

 private:
  /// force_ := the sum of the magnitudes of the forces on each DOF, N or N m: of loads, stiffness, dashpots and
  /// contacts that are closed at an end of the step.
  void sum_forces(const time::State& from, const time::State& to);
  void add_contacts(const time::State& from, const time::State& to);

  dynamics::Dynamics& dynamics_;
  double of_motion_;  ///< rounding of the motion as a whole over the tolerance
  double rate_;
  bool is_lumped_;    ///< M is diagonal
  Vector root_mass_;  ///< of the diagonal of M, kg^(1/2) or kg^(1/2) m
  /// The squared frequency of each DOF if the others are held, 1/s^2, and the larger of that frequency and the rate at
  /// which damping slows it, 1/s; 0 without either.
  Vector own_square_, own_rate_;
  Vector most_x_, most_v_;  ///< bounds of the scales of the motion as a whole
  Vector stop_stiffness_;
  Vector x_, v_, force_, w0_, w1_;
};

}  // namespace butee::integrators

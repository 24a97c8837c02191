#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

/// Taylor coefficients of the forces of obstacles, each in its contact phase, for TaylorExpander.
///
/// Quotients and powers follow from the recurrence of y = p^alpha, k p_0 y_k = sum_j (j alpha - (k
/// - j)) p_j y_{k-j}; tanh from y' = (1 - y^2) u'. Rigid sticking is a constraint and is not
/// handled here. Checked in tests/verification/friction_test.cpp and ring_test.cpp. Source of the
/// recurrences: R. Barrio, Appl. Math. Comput. 163 (2005) 525-545, doi 10.1016/j.amc.2004.02.015.
class ObstacleSeries {
 public:
  /// Throws InputError for laws and shapes without a series; only the linear law on lines and
  /// circles has one.
  ObstacleSeries(dynamics::Dynamics& dynamics, int order);

  /// Starts an expansion with the phases of the contacts at (t, x, v); `length` in s.
  void begin(double t, ConstVectorRef x, ConstVectorRef v, double length);
  /// force += coefficient k, from the coefficients 0 ... k of x and of v; to be called for k = 0,
  /// 1, 2, ...
  void add(Index k, ConstVectorRef x, ConstVectorRef v, VectorRef force);

 private:
  using Series = std::vector<double>;
  /// The series of a vector in the plane.
  struct Plane {
    Series y, z;
  };
  /// A contact that exerts a force, and the series from which its force is computed.
  struct Contact {
    Index index;
    dynamics::ContactPhase phase;
    double surface, surface_rate;  ///< m/s: of the surface at the start, and its change over the length
    double stretch;                ///< m
    Plane d, v, normal, tangent;
    Series square, radius, inverse, penetration, rate, pressing, along, slip, smooth, root, share, path, friction,
        turning;
  };

  /// True for a ring without a gap, friction and damping: the force is -k times the displacement from its centre.
  static bool is_round_spring(const model::ObstacleGroup& group);
  void add(Contact& contact, Index k, VectorRef force);
  void place(Contact& contact, Index k);
  double press(Contact& contact, Index k);
  double rub(Contact& contact, Index k);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  std::size_t terms_;
  double length_ = 1.0;
  std::vector<Contact> contacts_;
};

}  // namespace butee::integrators

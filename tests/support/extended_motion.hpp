#pragma once

#include <vector>

namespace butee::test {

/// A small system of masses, springs, stops and harmonic loads, in 80-bit arithmetic.
struct ExtendedSystem {
  using Real = long double;
  struct Stop {
    int a, b;  ///< w = x[a] - x[b]; b < 0: ground
    Real gap, stiffness;
    int sides;          ///< +1, -1; 0: both
    Real slope = 0.0L;  ///< pi lambda of the arctan law; 0: linear
  };
  struct Load {
    int dof;
    Real amplitude, omega, phase;
  };

  std::vector<Real> mass, displacement, velocity;
  std::vector<std::vector<Real>> stiffness, damping;
  std::vector<Stop> stops;
  std::vector<Load> loads;
};

/// Its motion: Taylor series of order 26 over at most 0.4 of the shortest 1/omega; each contact change is
/// located by bisection to the last bit. It shares no code with the framework.
struct ExtendedMotion {
  std::vector<std::vector<long double>> rows;  ///< displacements of each DOF at the times
  std::vector<double> peak;                    ///< largest |x| of each DOF, including motion between rows
  double contact_force = 0.0;                  ///< largest contact force of any stop
  std::vector<long double> end_x, end_v;
};

ExtendedMotion integrate_extended(const ExtendedSystem& system, const std::vector<double>& times);

/// Growth rate (1/s) of the logarithm of the distance between two motions until it is 1e-4 of the peak, and
/// the factor of growth up to then.
struct ExtendedGrowth {
  double rate, factor;
};
/// They start 1e-14 of the peak apart in DOF 0: in its displacement, or in its velocity scaled to
/// displacement without stops.
enum class Disturbed { velocity, displacement };
ExtendedGrowth grow_extended(const ExtendedSystem& system, double end_time, Disturbed disturbed = Disturbed::velocity);

}  // namespace butee::test

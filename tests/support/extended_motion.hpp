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

/// Its motion: Taylor series of order 26 over 0.4 of the shortest 1/omega and less, each change of contact located by
/// bisection to the last bit. It shares nothing with the framework.
struct ExtendedMotion {
  std::vector<std::vector<long double>> rows;  ///< displacements of each DOF at the times
  std::vector<double> peak;                    ///< largest |x| of each DOF, between rows too
  double contact_force = 0.0;                  ///< largest of any stop
  std::vector<long double> end_x, end_v;
};

ExtendedMotion integrate_extended(const ExtendedSystem& system, const std::vector<double>& times);

/// Rate (1/s) of ln of the distance of two motions until they are 1e-4 of the peak apart; and the factor by which they
/// part up to then.
struct ExtendedGrowth {
  double rate, factor;
};
/// They begin 1e-14 of the peak apart in DOF 0, in its displacement or in what velocity makes of it without stops.
enum class Disturbed { velocity, displacement };
ExtendedGrowth grow_extended(const ExtendedSystem& system, double end_time, Disturbed disturbed = Disturbed::velocity);

}  // namespace butee::test

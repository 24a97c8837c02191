#pragma once

#include <string>

namespace butee::test {

/// A mass `m` of 1 kg on a spring of `stiffness`, N/m, followed by the tables `more`; rk4 for 1 s.
std::string mass_on_spring(const std::string& stiffness, const std::string& more);

/// Masses `a` of 4 kg and `b` of 1 kg, followed by the tables `more`; rk4 for 1 s.
std::string two_masses(const std::string& more);

/// two_masses() with springs of 8 N/m from `a` to ground and 3 N/m to `b`, and stops of 400 N/m with a
/// gap of 0.1 m on both, followed by the tables `more`.
std::string masses_in_stops(const std::string& more);

/// A steel pipe of 120 x 80 mm that turns at 30 rad/s and rubs against a ring at every node; an unbalance
/// drives its middle.
struct TurningPipe {
  std::string name;
  std::string motion;  ///< "lateral" or "spatial"
  std::string length;  ///< m
  int elements;
  std::string gap, slip_speed;  ///< of the rings, m and m/s
  std::string unbalance;        ///< kg m

  /// The scene, followed by the tables `more`.
  std::string scene(const std::string& more) const;
};

}  // namespace butee::test

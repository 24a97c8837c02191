#pragma once

#include <string>

namespace butee::test {

/// A mass `m` of 1 kg on a spring of `stiffness`, N/m, with more tables behind it; rk4 for 1 s.
std::string mass_on_spring(const std::string& stiffness, const std::string& more);

/// Masses `a` of 4 kg and `b` of 1 kg with more tables behind them; rk4 for 1 s.
std::string two_masses(const std::string& more);

/// A steel pipe of 120 x 80 mm that turns at 30 rad/s, strikes a ring at every node and rubs; an unbalance drives its
/// middle.
struct TurningPipe {
  std::string name;
  std::string motion;  ///< "lateral" or "spatial"
  std::string length;  ///< m
  int elements;
  std::string gap, slip_speed;  ///< of the rings, m and m/s
  std::string unbalance;        ///< kg m

  /// The scene, with more tables behind it.
  std::string scene(const std::string& more) const;
};

}  // namespace butee::test

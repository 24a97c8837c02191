#pragma once

#include <optional>

#include <butee/model/system.hpp>

namespace butee::app::check {

/// Static estimates of loads, structure and stops, rings and planes among them, from a few solutions with K and M.
struct Mechanics {
  /// Stiffness of a closed stop over that of the structure at the stop, 1/(s^T K^-1 s): smallest and largest
  /// ratio; empty if the structure has a rigid motion.
  std::optional<double> least_ratio, largest_ratio;
  double shortest_contact = 0.0;  ///< s, dynamics::shortest_impact(); 0 without stops
  double smallest_gap = 0.0;      ///< m, among the stops; 0 without stops
  /// The largest static displacement at a stop under the amplitudes of all loads, m; empty without loads or
  /// stops, or if the structure has a rigid motion.
  std::optional<double> static_deflection;
  Index closed_by_constants = 0;  ///< stops that the lasting part of the loads closes statically
  Index closed_at_start = 0;      ///< stops that the initial displacement has closed
  Index sampled = 0;              ///< number of stops that were examined
};

Mechanics mechanics_of(const model::System& system, double end_time);

/// The largest static displacement that the residual forces of all open stops together cause; empty if K is
/// singular.
std::optional<double> pull_displacement(const model::System& system);

}  // namespace butee::app::check

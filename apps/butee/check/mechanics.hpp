#pragma once

#include <optional>

#include <butee/model/system.hpp>

namespace butee::app::check {

/// What stands between the loads, the structure and its stops, from a few solutions with K and M.
struct Mechanics {
  /// Stiffness of a closed stop over that of the structure where it acts, 1/(s^T K^-1 s): smallest and largest; nothing
  /// where the structure is free to move.
  std::optional<double> least_ratio, largest_ratio;
  double shortest_contact = 0.0;  ///< s, pi sqrt(m/k_c) with m = 1/(s^T M^-1 s); 0 without stops
  double smallest_gap = 0.0;      ///< m, among the stops; 0 without stops
  /// The largest displacement of a stop under all loads' amplitudes at rest, m; nothing without loads or stops, or
  /// where the structure is free to move.
  std::optional<double> static_deflection;
  Index closed_by_constants = 0;  ///< stops that the lasting part of the loads presses shut, at rest
  Index closed_at_start = 0;      ///< stops that the initial displacement has closed
  Index sampled = 0;              ///< stops looked at, of all
};

Mechanics mechanics_of(const model::System& system, double end_time);

/// The largest displacement that the pull of all open stops together gives the structure at rest; nothing where K is
/// singular.
std::optional<double> pull_displacement(const model::System& system);

}  // namespace butee::app::check

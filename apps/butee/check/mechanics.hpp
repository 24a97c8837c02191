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
  /// Stops of one kind: on displacements (m) or on rotations (rad).
  struct Play {
    double smallest_gap;
    /// The largest static displacement at one of them under the amplitudes of all loads; empty without loads, or if
    /// the structure has a rigid motion.
    std::optional<double> static_deflection;
  };
  std::optional<Play> displacements, rotations;  ///< empty without stops of that kind
  Index closed_by_constants = 0;                 ///< stops that the lasting part of the loads closes statically
  Index closed_at_start = 0;                     ///< stops that the initial displacement has closed
  Index sampled = 0;                             ///< number of stops that were examined
};

Mechanics mechanics_of(const model::System& system, double end_time);

/// Whether stops act on a rotation: their gap is in rad, their force a moment in N m.
bool acts_on_rotation(const model::System& system, const model::FreeStops& stops);

/// The open stop that the residual forces of a law (ContactLaw::asymptotic_force) at all open stops displace by the
/// largest part of its gap.
struct ResidualPull {
  const model::FreeStops* stops = nullptr;  ///< it is one of these
  std::optional<double> displacement;       ///< there, static, m or rad; empty if K is singular
};
/// Empty if no law has a residual force.
std::optional<ResidualPull> residual_pull(const model::System& system);

}  // namespace butee::app::check

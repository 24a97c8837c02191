#pragma once

#include <array>
#include <span>

#include "butee/core/types.hpp"

namespace butee::dynamics::kernel {

/// Accumulated motion of the stops: end, speed, middle (StopMotion), one entry per stop, padded to
/// chunks.
struct Motion {
  double *end, *speed, *middle;
};

/// Response of all stops to forces P_0, P_1, P_2 at one stop: nine columns, end, speed and middle
/// for each force, `rows` entries apart.
struct ResponseColumns {
  const double* values;
  Index rows;
};

/// The response columns of a stop and the force on it.
struct StopForce {
  ResponseColumns columns;
  std::array<double, 3> force;
};

struct StopResponse {
  /// Adds the response to one force for the stops of these chunks; a chunk is named by its first
  /// stop. Returns the largest |end| + speed_weight |speed| + |middle| of the response, not finite
  /// if the force is not.
  double (*add_force)(const StopForce&, double speed_weight, std::span<const Index> chunks, const Motion&);
  /// Adds the responses to all of these forces.
  void (*add_forces)(std::span<const StopForce>, std::span<const Index> chunks, const Motion&);
};

/// For the chosen instruction set.
const StopResponse& stop_response();

}  // namespace butee::dynamics::kernel

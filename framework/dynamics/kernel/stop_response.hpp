#pragma once

#include <array>
#include <span>

#include "butee/core/types.hpp"

namespace butee::dynamics::kernel {

/// Where the motion of the stops is added up: end, speed, middle (StopMotion), an entry a stop, padded to chunks.
struct Motion {
  double *end, *speed, *middle;
};

/// What forces P_0, P_1, P_2 at one stop do to all: nine columns, end, speed and middle by each, `rows` entries apart.
struct ResponseColumns {
  const double* values;
  Index rows;
};

/// A stop's columns and the force on it.
struct StopForce {
  ResponseColumns columns;
  std::array<double, 3> force;
};

struct StopResponse {
  /// Adds what one force does to the stops of these chunks, named by where each begins. The largest |end| +
  /// speed_weight |speed| + |middle| of it, not finite where one of them is not.
  double (*add_force)(const StopForce&, double speed_weight, std::span<const Index> chunks, const Motion&);
  /// Adds what all of these forces do.
  void (*add_forces)(std::span<const StopForce>, std::span<const Index> chunks, const Motion&);
};

/// Of the chosen instruction set.
const StopResponse& stop_response();

}  // namespace butee::dynamics::kernel

#pragma once

#include "run.hpp"

namespace butee::stress {

/// A run of very many steps: a driven, damped mass that strikes its stop in every period.
struct LongRun {
  bool is_sound = false;  ///< completed, finite, and the last tenth is as large as the second
  std::int64_t steps = 0;
  double first = 0.0, last = 0.0;  ///< m, largest displacements in the second and the last tenth
  double seconds = 0.0;
  std::string message;
};

/// `steps` of fixed length; for methods that choose their steps, the number of periods that takes about as
/// many steps.
LongRun run_long(const Method& method, std::int64_t steps);

}  // namespace butee::stress

#pragma once

#include "run.hpp"

namespace butee::stress {

/// A run of very many steps, of a driven and damped mass that strikes its stop in every period.
struct LongRun {
  bool is_sound = false;  ///< completed, finite, and its last tenth as large as its second
  std::int64_t steps = 0;
  double first = 0.0, last = 0.0;  ///< m, the largest displacements in those tenths
  double seconds = 0.0;
  std::string message;
};

/// `steps` of fixed length; methods that choose their steps get as many periods as fit the same number of theirs.
LongRun run_long(const Method& method, std::int64_t steps);

}  // namespace butee::stress

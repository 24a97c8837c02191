#pragma once

#include <butee/record/trust.hpp>

#include "session.hpp"

namespace butee::app {

/// Runs the scene again: as it is, with its step or tolerance tightened, and twice from starts that differ by a small
/// fraction of the peak; compares. Throws RunError where one of these runs fails.
record::Trust find_trust(scene::Scene& session);

}  // namespace butee::app

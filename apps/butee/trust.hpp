#pragma once

#include <butee/record/trust.hpp>

#include "session.hpp"

namespace butee::app {

/// Runs the scene again: unchanged, with a tightened step or tolerance, and twice from starts that differ by
/// a small fraction of the peak; compares the results. Throws RunError if one of these runs fails.
record::Trust find_trust(scene::Scene& session);

}  // namespace butee::app

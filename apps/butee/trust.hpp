#pragma once

#include <butee/record/trust.hpp>

#include "session.hpp"

namespace butee::app {

/// Runs the scene again: unchanged, with a tightened step or tolerance, from starts that differ by a small fraction of
/// the peak, and by a method of another family; compares the results. Throws RunError if the unchanged run fails or the
/// user interrupts; others that fail are left out.
record::Trust find_trust(scene::Scene& session);

}  // namespace butee::app

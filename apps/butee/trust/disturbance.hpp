#pragma once

#include <butee/record/growth.hpp>

#include "followed_run.hpp"

namespace butee::app::trust {

/// Follows a disturbance of the states of a run. Its size is `size` times the largest motion. Each interval
/// between two stored states is computed again from a disturbed state. The difference at its end, rescaled to
/// the same size, is the disturbance of the next interval. The first disturbance gives all DOFs the same
/// kinetic energy.
///
/// Sizes are |d|^2 = d_v^T M d_v + max(d_x^T K d_x, omega^2 d_x^T M d_x), omega^2 = max v^T M v/max x^T M x.
/// Empty for a run at rest, or if an interval cannot be computed. If it `repeats`, each interval is also computed again
/// from the stored state, and the difference is that to this motion: without error control the steps of an interval
/// that begins at a stored state have other errors than those of the run.
record::Growth follow_disturbance(scene::Scene& session, const FollowedRun& run, double size, bool repeats);

}  // namespace butee::app::trust

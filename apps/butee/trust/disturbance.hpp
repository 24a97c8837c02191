#pragma once

#include <butee/record/growth.hpp>

#include "followed_run.hpp"

namespace butee::app::trust {

/// Follows a disturbance of the states of a run, `size` times the largest motion: each piece between two of them is
/// computed again from a state that is disturbed, and the difference at its end, made as small again, disturbs the
/// next. The first disturbance gives all DOFs the same kinetic energy.
///
/// Sizes are |d|^2 = d_v^T M d_v + max(d_x^T K d_x, omega^2 d_x^T M d_x), omega^2 = max v^T M v/max x^T M x. Nothing
/// for a run at rest, and where a piece cannot be computed.
record::Growth follow_disturbance(scene::Scene& session, const FollowedRun& run, double size);

}  // namespace butee::app::trust

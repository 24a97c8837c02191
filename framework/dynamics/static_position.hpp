#pragma once

#include "butee/dynamics/dynamics.hpp"

namespace butee::dynamics {

/// The position at rest relative to the base under the loads of an instant, K x = F(t) + F_c(x), by Newton's iteration
/// with the stops that are closed there, starting from `start` (n); residual below 1e-12 of the
/// forces. Throws InputError if the structure is not supported, naming the free motion, or if the
/// iteration did not converge.
BUTEE_EXPORT Vector static_position(Dynamics& dynamics, double t, const Vector& start);

}  // namespace butee::dynamics

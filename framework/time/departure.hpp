#pragma once

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/state.hpp"

namespace butee::time {

/// Moves stops that start exactly in the middle of their gap, and bodies in the centre of a ring, off it, by 1e-100
/// gaps.
///
/// A law with a residual force (arctan) pulls a stop with two sides towards the nearer one. At w = 0
/// this force is zero, and it jumps on both sides of it: an unstable equilibrium. A motion that
/// leaves it has the residual force from its first instant on, so that a method which takes the
/// force at w = 0 for that of the beginning motion is wrong by up to the whole jump, or leaves to
/// the other side. The direction is that of the speed of the stop or, if it is at rest, the one in
/// which the other forces drive it. It is found by steps of the classical Runge-Kutta method of a
/// millionth of 1/omega: their weights are all positive, so that a force which keeps its direction
/// moves the stop in it. Each step reaches the next mass of a chain; what no step reaches stays where
/// it is until a load begins (Integrator::pass_discontinuity()).
/// Checked in tests/verification/departure_test.cpp. Returns whether a contact has been moved.
BUTEE_EXPORT bool leave_middle(dynamics::Dynamics& dynamics, State& state);

}  // namespace butee::time

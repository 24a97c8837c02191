#pragma once

#include "scenes.hpp"

namespace butee::stress {

/// A random scene with contacts in the plane, dissipation or friction: rotors and shafts in rings, two bodies
/// in a ring, a block on a plane or a belt, rows of masses with friction supports, bodies between damped
/// stops. All kinds of damping and friction occur, including stick springs and rigid stick.
Scene rubbing_scene(std::uint64_t seed);

}  // namespace butee::stress

#pragma once

#include "scenes.hpp"

namespace butee::stress {

/// A random scene in two planes or in space: shafts with discs on bearings with or without cross terms, at
/// rest, at constant speed or in a run-up, with unbalance and rotating damping; beams in two planes with
/// preload and modal damping; frames in space by all three theories, under weight, on a moving base. Stops
/// act on u of some nodes.
Scene space_scene(std::uint64_t seed);

}  // namespace butee::stress

#pragma once

#include <optional>

#include "rubbing_scenes.hpp"
#include "scenes.hpp"
#include "space_scenes.hpp"

namespace butee::stress {

/// A random scene with features that random_scene() lacks; lengths, masses and stiffnesses are around 1, 1
/// and 1e4 in SI units. Mass ratios to 1e-8, joined and uneven beams of several sections with rotary inertia,
/// springs and dashpots on rotations and between parts, modal damping, several stops with both laws at all
/// values of regularization, overlapping, preloaded, without a gap or between parts, impulses of 1e-10 s,
/// rotating loads, moments, free bodies, flights between hard stops. Tolerances from 1e-2 to 1e-10.
Scene wide_scene(std::uint64_t seed);

/// By seed: every tenth scene by space_scene(), another tenth by rubbing_scene(), every third of the rest by
/// random_scene(), the others by wide_scene().
inline Scene mixed_scene(std::uint64_t seed) {
  if (seed % 10 == 9) return space_scene(seed);
  if (seed % 10 == 4) return rubbing_scene(seed);
  return seed % 3 == 0 ? random_scene(seed) : wide_scene(seed);
}

/// The random scene of a name such as "wide 17".
std::optional<Scene> random_scene_of(const std::string& name);

}  // namespace butee::stress

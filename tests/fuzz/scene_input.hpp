#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <butee/scene/read_scene.hpp>

namespace butee::fuzz {

/// The standard types and every method of integrators/.
plugin::Catalogue& catalogue();

/// Reads the bytes as the program reads a scene; empty if they are refused with an InputError, as bad input
/// must be. Mesh sizes are limited, so that an input takes milliseconds.
std::optional<scene::Scene> read_scene_input(const std::uint8_t* data, std::size_t size);

}  // namespace butee::fuzz

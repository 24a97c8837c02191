#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <butee/scene/read_scene.hpp>

namespace butee::fuzz {

/// The standard types and every method of integrators/.
plugin::Catalogue& catalogue();

/// Reads the bytes as the program reads a scene; nothing where they are refused with an InputError, as bad input has to
/// be. Meshes are kept small, whatever the bytes say: an input is to cost milliseconds.
std::optional<scene::Scene> read_scene_input(const std::uint8_t* data, std::size_t size);

}  // namespace butee::fuzz

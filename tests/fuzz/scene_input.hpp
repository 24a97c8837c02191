#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <butee/plugin/scene.hpp>
#include <butee/record/output_request.hpp>

namespace butee::fuzz {

/// A scene made from any bytes.
struct SceneInput {
  plugin::Scene scene;
  record::OutputRequest output;
};

/// The standard types and every method of integrators/.
plugin::Catalogue& catalogue();

/// Reads the bytes as the program reads a scene; nothing where they are refused with an InputError, as bad input has to
/// be. Meshes are kept small, whatever the bytes say: an input is to cost milliseconds.
std::optional<SceneInput> read_scene_input(const std::uint8_t* data, std::size_t size);

}  // namespace butee::fuzz

#include "scene_input.hpp"

/// Any bytes are a scene or are refused: the reader of TOML, the overrides' value, and the whole of the model.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  butee::fuzz::read_scene_input(data, size);
  return 0;
}

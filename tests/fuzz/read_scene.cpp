#include "scene_input.hpp"

/// Any bytes must give a scene or be refused: by the TOML reader, the parser of override values, and the
/// reader of the whole model.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  butee::fuzz::read_scene_input(data, size);
  return 0;
}

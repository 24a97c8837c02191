#pragma once

#include <nlohmann/json.hpp>

namespace butee::app {

/// Keeps the order in which keys are added; writes non-finite numbers as null.
using Json = nlohmann::ordered_json;

/// Prints to standard output, indented, with a line end.
inline void print_json(const Json& json) {
  std::printf("%s\n", json.dump(2).c_str());
}

}  // namespace butee::app

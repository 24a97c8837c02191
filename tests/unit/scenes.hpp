#pragma once

#include <string>

#include <butee/core/error.hpp>

#include "support/scene_run.hpp"

namespace butee::test {

/// Schema and a minimal [integrator], for scenes that are only assembled.
inline const std::string kHeader = R"(
schema = 1

[integrator]
type      = "newmark_modified"
time_step = 1.0e-3
end_time  = 1.0
)";

constexpr double kYoung = 2.0e11, kDensity = 8000.0, kArea = 2.0e-3, kSecondMoment = 3.0e-6;
constexpr double kBending = kYoung * kSecondMoment, kMassPerLength = kDensity * kArea;

/// A material "steel" and a section "bar" with the values above.
inline const std::string kSteelBar = R"(
[material.steel]
young_modulus = 2.0e11
density       = 8000.0

[section.bar]
shape         = "general"
area          = 2.0e-3
second_moment = 3.0e-6
)";

/// A beam of steel and bar; `mesh` contains its length and elements, or coordinates, and other keys.
inline std::string beam(const std::string& name, const std::string& mesh) {
  return "\n[[element]]\ntype = \"beam\"\nname = \"" + name + "\"\nmaterial = \"steel\"\nsection = \"bar\"\n" + mesh +
         "\n";
}

inline std::string mass(const std::string& name, const std::string& value) {
  return "\n[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + value + "\n";
}

inline std::string support(const std::string& nodes, const std::string& fix) {
  return "\n[[support]]\nnodes = " + nodes + "\nfix = " + fix + "\n";
}

/// The message with which the scene is refused, or "" if it is accepted.
inline std::string refusal(const std::string& toml) {
  try {
    const SceneRun scene(toml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace butee::test

#pragma once

#include <string>

namespace butee::test {

/// The tables of a round steel bar of 2 m, `bar`, whose ends are held across.
inline std::string pinned_bar(int elements) {
  return R"(
schema = 1
[material.steel]
young_modulus = 2e11
density       = 7800.0
[section.round]
shape  = "circle"
radius = 0.005
[[element]]
type = "beam"
name = "bar"
material = "steel"
section = "round"
length = 2.0
elements = )" +
         std::to_string(elements) + "\n[[support]]\nnodes = [\"bar:first\", \"bar:last\"]\nfix = [\"u\"]\n";
}

}  // namespace butee::test

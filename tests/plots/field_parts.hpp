#pragma once

namespace butee::test {

/// A string of steel with a rotor on a spring, without stop, load or method.
inline constexpr const char* kParts = R"(schema = 1
title = "a string & a rotor"
[material.steel]
young_modulus = 2.0e11
density = 8000.0
[section.pipe]
shape = "general"
area = 2.0e-3
second_moment = 3.0e-6
[[element]]
type = "beam"
name = "string"
material = "steel"
section = "pipe"
length = 10.0
elements = 10
[[element]]
type = "mass"
name = "rotor"
mass = 5.0
[[element]]
type = "spring"
nodes = ["rotor", "string:3"]
stiffness = 1.0e4
[[support]]
nodes = ["string:first", "string:last"]
fix = ["u"]
)";

}  // namespace butee::test

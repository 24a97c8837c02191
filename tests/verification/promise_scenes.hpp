#pragma once

namespace butee::test::promise_test {

struct Scene {
  const char* name;
  const char* text;
  double end_time;
};

inline constexpr const char* kLightPart = R"(
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "mass"
name = "b"
mass = 1e-6
[[element]]
type = "spring"
node = "a"
stiffness = 1e4
[[element]]
type = "spring"
nodes = ["a", "b"]
stiffness = 1.0
damping = 1e-9
[initial]
velocity = [{ nodes = "a", value = 0.3 }]
)";

inline constexpr const char* kRotations = R"(
[material.steel]
young_modulus = 2.1e11
density = 7850.0
[section.pipe]
shape = "general"
area = 5.5e-4
second_moment = 8.6e-8
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "pipe"
coordinates = [0.0, 0.8, 1.3, 2.0]
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[element]]
type = "mass"
node = "b:2"
name = "disc"
mass = 5.0
rotary_inertia = 0.5
[[contact]]
type = "stop"
nodes = "b:2"
gap = 5e-4
law = "linear"
stiffness = 1e6
[damping]
mass_proportional = 2.0
stiffness_proportional = 2e-5
[[load]]
type = "harmonic"
node = "b:1"
dof = "theta"
amplitude = 30.0
angular_frequency = 60.0
)";

inline constexpr const char* kHardStop = R"(
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 100.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.1
law = "linear"
stiffness = 1e8
[initial]
velocity = [{ nodes = "m", value = 3.0 }]
)";

inline constexpr const char* kImpulse = R"(
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e4
damping = 1.0
[[contact]]
type = "stop"
nodes = "m"
gap = 1e-3
law = "linear"
stiffness = 1e6
[[load]]
type = "table"
node = "m"
times = [0.05, 0.0500000001, 0.0500000002]
values = [0.0, 1.5e9, 0.0]
)";

inline constexpr const char* kFreeBodies = R"(
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "mass"
name = "b"
mass = 2.0
[[contact]]
type = "stop"
between = ["a", "b"]
gap = 0.05
law = "linear"
stiffness = 1e4
[initial]
velocity = [{ nodes = "a", value = 1.0 }]
)";

// Starts from rest, so that the first step covers most of the displacement reached so far.
inline constexpr const char* kSwitchedOn = R"(
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e4
[[load]]
type = "ramp"
node = "m"
to = 20.0
start = 0.02
end = 0.02000006
)";

/// A stop in the middle excites fast modes, visible in velocities and rotations.
inline constexpr const char* kStruckBeam = R"(
[material.steel]
young_modulus = 2.1e11
density = 7850.0
[section.pipe]
shape = "general"
area = 5.5e-4
second_moment = 8.6e-8
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "pipe"
length = 2.0
elements = 4
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "b:middle"
gap = 1e-3
law = "linear"
stiffness = 1e6
[[load]]
type = "harmonic"
node = "b:1"
amplitude = 400.0
angular_frequency = 60.0
)";

/// A light body that strikes a stop, and a lighter one that swings freely, beside the large force on a heavy one.
inline constexpr const char* kBesideLargeForce = R"(
[[element]]
type = "mass"
name = "heavy"
mass = 1e3
[[element]]
type = "mass"
name = "bouncing"
mass = 1e-8
[[element]]
type = "spring"
node = "bouncing"
stiffness = 0.01
[[element]]
type = "mass"
name = "swinging"
mass = 3e-9
[[element]]
type = "spring"
node = "swinging"
stiffness = 0.02
[[contact]]
type = "stop"
nodes = "bouncing"
gap = 5e-4
sides = "positive"
law = "arctan"
stiffness = 10.0
regularization = 3e4
[[load]]
node = "heavy"
type = "constant"
value = 1e6
[initial]
velocity = [{ nodes = "bouncing", value = 1.0 }, { nodes = "swinging", value = 0.5 }]
)";

inline constexpr Scene kScenes[] = {
    {"struck_beam", kStruckBeam, 0.06}, {"light_part", kLightPart, 0.1},
    {"rotations", kRotations, 0.05},    {"hard_stop", kHardStop, 0.5},
    {"impulse", kImpulse, 0.2},         {"free_bodies", kFreeBodies, 0.6},
    {"switched_on", kSwitchedOn, 0.1},  {"beside_large_force", kBesideLargeForce, 0.02}};

}  // namespace butee::test::promise_test

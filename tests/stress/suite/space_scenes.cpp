#include "space_scenes.hpp"

#include <array>
#include <cmath>

#include "scene_text.hpp"

namespace butee::stress::in_space {
namespace {

constexpr double kYoung = 2e11, kDensity = 7900.0;

std::string key(const char* name, double value) {
  return std::string(name) + " = " + to_text(value) + "\n";
}

/// A beam of `length` m in n elements; its first pinned frequency sets the time scale of the scene.
struct Shaft {
  double length, radius;
  int elements;
  double omega() const {
    return std::pow(2.0 * kQuarterTurn / length, 2) * std::sqrt(kYoung / kDensity) * 0.5 * radius;
  }
  double stiffness() const { return 48.0 * kYoung * kQuarterTurn / 2.0 * std::pow(radius, 4) / std::pow(length, 3); }
  double mass() const { return kDensity * 2.0 * kQuarterTurn * radius * radius * length; }
};

Shaft random_shaft(Random& random) {
  const double length = random.decades(-0.3, 0.7);
  return {length, length * random.decades(-2.0, -1.3), random.integer(1, 2) * 2};
}

std::string head(const Shaft& shaft) {
  return "schema = 1\n[material.s]\n" + key("young_modulus", kYoung) + key("density", kDensity) +
         "poisson_ratio = 0.3\n[section.c]\nshape = \"circle\"\n" + key("radius", shaft.radius);
}

std::string theory(Random& random) {
  const std::array<const char*, 3> names = {"euler", "rayleigh", "timoshenko"};
  return std::string("theory = \"") + names[static_cast<std::size_t>(random.integer(0, 2))] + "\"\n";
}

std::string stop(const std::string& node, double gap, double stiffness) {
  return "[[contact]]\ntype = \"stop\"\nnodes = \"" + node + "\"\n" + key("gap", gap) + key("stiffness", stiffness);
}

std::string harmonic(const std::string& node, const std::string& dof, double force, double omega, double phase) {
  return "[[load]]\ntype = \"harmonic\"\nnode = \"" + node + "\"\ndof = \"" + dof + "\"\n" + key("amplitude", force) +
         key("angular_frequency", omega) + key("phase", phase);
}

std::string damping(const Shaft& shaft, bool turns, Random& random) {
  const double ratio = random.decades(-3.0, -1.0);
  std::string text = "[damping]\n";
  if (!turns && random.chance(0.3)) return text + key("modal", ratio);
  text += random.chance(0.5) ? key("mass_proportional", 2.0 * ratio * shaft.omega())
                             : key("stiffness_proportional", 2.0 * ratio / shaft.omega());
  if (turns && random.chance(0.4)) text += key("rotating_stiffness_proportional", 0.3 * ratio / shaft.omega());
  return text;
}

std::string bearing(const std::string& node, double stiffness, Random& random) {
  const double cross = random.chance(0.4) ? 0.05 * stiffness * random.uniform(-1.0, 1.0) : 0.0;
  const double c = random.chance(0.7) ? stiffness * random.decades(-5.0, -4.0) : 0.0;
  return "[[element]]\ntype = \"bearing\"\nnode = \"" + node + "\"\nstiffness = [[" + to_text(stiffness) + ", " +
         to_text(cross) + "], [" + to_text(-cross) + ", " + to_text(stiffness * random.uniform(0.5, 1.5)) +
         "]]\ndamping = [[" + to_text(c) + ", 0], [0, " + to_text(c) + "]]\n";
}

/// A shaft on two bearings, or pinned, with a disc; the disc may have a stop.
Scene rotor(Random& random) {
  const Shaft shaft = random_shaft(random);
  const double omega = shaft.omega(), size = shaft.length * random.decades(-5.0, -3.0);
  const double mass = shaft.mass() * random.decades(-1.0, 0.5), diametral = mass * shaft.radius * shaft.radius * 4.0;
  Scene scene;
  scene.size = size;
  scene.toml = head(shaft) + "[[element]]\ntype = \"beam\"\nname = \"b\"\nmotion = \"lateral\"\n" + theory(random) +
               "material = \"s\"\nsection = \"c\"\n" + key("length", shaft.length) +
               "elements = " + std::to_string(shaft.elements) + "\n[[element]]\ntype = \"disc\"\nnode = \"b:1\"\n" +
               key("mass", mass) + key("diametral_inertia", diametral) +
               key("polar_inertia", diametral * random.uniform(0.5, 2.0));
  if (random.chance(0.5))
    scene.toml += bearing("b:first", shaft.stiffness() * random.decades(-1.0, 1.0), random) +
                  bearing("b:last", shaft.stiffness() * random.decades(-1.0, 1.0), random);
  else
    scene.toml += "[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"uy\", \"uz\"]\n";
  scene.end_time = random.uniform(1.0, 4.0) * 4.0 * kQuarterTurn / omega;
  const double kind = random.uniform(0.0, 1.0), speed = omega * random.uniform(0.2, 1.5);
  const bool turns = kind > 0.15;
  if (turns)
    scene.toml += kind < 0.6 ? "[rotation]\n" + key("speed", speed)
                             : "[rotation]\nspeed = { type = \"ramp\", from = " + to_text(0.3 * speed) +
                                   ", to = " + to_text(speed) + ", end = " + to_text(0.7 * scene.end_time) + " }\n";
  if (turns)
    scene.toml += "[[load]]\ntype = \"unbalance\"\nnode = \"b:1\"\n" +
                  key("moment", size * shaft.stiffness() / (speed * speed) * random.decades(-0.5, 0.7)) +
                  key("phase", random.uniform(0.0, 6.0));
  else
    scene.toml += harmonic("b:1", "uz", size * shaft.stiffness(), 0.7 * omega, 0.3) +
                  harmonic("b:1", "uy", size * shaft.stiffness(), 0.7 * omega, 1.3);
  return scene.toml += damping(shaft, turns, random) + stop("b:1", size, shaft.stiffness() * random.decades(-1.0, 3.0)),
         scene;
}

/// Two beams at an angle, or a beam in two planes with preload.
Scene frame(Random& random) {
  const Shaft shaft = random_shaft(random);
  const double omega = shaft.omega(), size = shaft.length * random.decades(-5.0, -3.0);
  const double force = size * shaft.stiffness();
  Scene scene;
  scene.size = size;
  scene.end_time = random.uniform(1.0, 3.0) * 4.0 * kQuarterTurn / omega;
  scene.toml = head(shaft);
  if (random.chance(0.5)) {
    const double critical =
        std::pow(2.0 * kQuarterTurn / shaft.length, 2) * kYoung * kQuarterTurn / 2.0 * std::pow(shaft.radius, 4);
    scene.toml += "[[element]]\ntype = \"beam\"\nname = \"b\"\nmotion = \"lateral\"\n" + theory(random) +
                  "material = \"s\"\nsection = \"c\"\n" + key("length", shaft.length) +
                  key("preload", critical * random.uniform(-0.8, 3.0)) +
                  "elements = " + std::to_string(shaft.elements) +
                  "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"uy\", \"uz\"]\n" +
                  stop("b:1", size, shaft.stiffness() * random.decades(-1.0, 3.0));
  } else {
    const std::string l = to_text(shaft.length), tilt = to_text(shaft.length * random.uniform(-0.5, 0.5));
    const std::string beam = "[[element]]\ntype = \"beam\"\nmotion = \"spatial\"\nmaterial = \"s\"\nsection = \"c\"\n" +
                             theory(random) + "elements = 2\n";
    scene.toml += beam + "name = \"a\"\npoints = [[0, 0, 0], [" + tilt + ", " + l + ", 0.0]]\nup = [0, 0, 1]\n" + beam +
                  "name = \"b\"\npoints = [[" + tilt + ", " + l + ", 0.0], [" + l + ", " + l + ", " + tilt +
                  "]]\nstart_node = \"a:last\"\n[[support]]\nnodes = [\"a:first\", \"b:last\"]\nfix = [\"ux\", "
                  "\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n" +
                  stop("a:last", 0.1 * size, shaft.stiffness() * random.decades(-1.0, 3.0)) +
                  harmonic("a:last", "ux", force, 1.3 * omega, 0.2);
    if (random.chance(0.5)) scene.toml += "[gravity]\nacceleration = [0.0, -9.81, 0.0]\n";
  }
  if (random.chance(0.4))
    scene.toml += "[base]\nacceleration = { direction = [0, 1, 1], type = \"harmonic\", amplitude = " +
                  to_text(size * omega * omega) + ", angular_frequency = " + to_text(0.8 * omega) + " }\n";
  else
    scene.toml += harmonic("b:1", "uz", force, 0.6 * omega, 0.7);
  return scene.toml += damping(shaft, false, random), scene;
}

}  // namespace

Scene make(std::uint64_t seed) {
  Random random(seed * 15485863U + 3U);
  Scene scene = random.chance(0.6) ? rotor(random) : frame(random);
  scene.name = "space ";
  scene.name += std::to_string(seed);
  scene.tolerance = random.decades(-6.0, -2.0);
  scene.step_factor = random.decades(-2.0, 0.5);
  return scene;
}

}  // namespace butee::stress::in_space

namespace butee::stress {

Scene space_scene(std::uint64_t seed) {
  return in_space::make(seed);
}

}  // namespace butee::stress

#include "rubbing_scenes.hpp"

#include <array>
#include <cmath>

#include "scene_text.hpp"

namespace butee::stress::rubbing {
namespace {

std::string key(const char* name, double value) {
  return std::string(name) + " = " + to_text(value) + "\n";
}

std::string pair(const char* name, double a, double b) {
  return std::string(name) + " = [" + to_text(a) + ", " + to_text(b) + "]\n";
}

/// Basis for the keys of a contact: mass m on springs k that moves by `size`, w = sqrt(k/m).
struct Body {
  double mass, stiffness, size;
  double omega() const { return std::sqrt(stiffness / mass); }
  double speed() const { return size * omega(); }
};

Body random_body(Random& random) {
  return {random.decades(-1.0, 1.0), random.decades(3.0, 5.0), random.decades(-4.0, -2.0)};
}

std::string damping(const Body& body, double stiffness, bool is_hertz, Random& random) {
  const double critical = 2.0 * std::sqrt(stiffness * body.mass);
  switch (random.integer(0, 5)) {
    case 0:
      return "damping = { type = \"kelvin_voigt\", coefficient = " + to_text(critical * random.decades(-2.0, -0.2)) +
             (random.chance(0.3) ? ", pull = true" : "") + " }\n";
    case 1:
      return "damping = { type = \"hunt_crossley\", factor = " + to_text(random.decades(-1.5, 0.3) / body.speed()) +
             " }\n";
    case 2:
      if (!is_hertz) return "";
      return "damping = { type = \"jankowski\", restitution = " + to_text(random.uniform(0.5, 0.95)) +
             ", mass = " + to_text(body.mass) + " }\n";
    default:
      return "";
  }
}

enum class Stick { any, not_rigid };

std::string friction(const Body& body, double stiffness, Stick stick, bool may_turn, Random& random) {
  const double mu = random.decades(-1.3, -0.1);
  std::string text = "friction = { coefficient = " + to_text(mu);
  const std::array<const char*, 3> names = {"sqrt", "tanh", "clip"};
  const double kind = random.uniform(0.0, 1.0);
  const std::string more = random.chance(0.4) ? ", static_coefficient = " + to_text(mu * random.uniform(1.0, 1.6)) : "";
  if (kind < 0.55)
    text += ", slip_speed = " + to_text(body.speed() * random.decades(-2.5, 0.0)) + ", smoothing = \"" +
            names[static_cast<std::size_t>(random.integer(0, 2))] + "\"";
  else if (kind < 0.8 || stick == Stick::not_rigid)
    text += ", stick_stiffness = " + to_text(stiffness * random.decades(-1.0, 1.0)) + more +
            (random.chance(0.5)
                 ? ", stick_damping = " + to_text(random.decades(-2.0, 0.0) * std::sqrt(stiffness * body.mass))
                 : "");
  else
    text += ", stick = \"rigid\"" + more;
  if (may_turn && random.chance(0.3)) text += ", surface_speed = " + to_text(body.speed() * random.uniform(-1.0, 1.0));
  return text + " }\n";
}

/// Keys common to all contacts; one law in four is Hertz's.
std::string law(const Body& body, double gap, double& stiffness, Random& random) {
  stiffness = body.stiffness * random.decades(-0.5, 3.0);
  const bool is_hertz = random.chance(0.25);
  // Stiffness that gives the same force at a tenth of the size.
  const double factor = is_hertz ? stiffness / std::sqrt(0.1 * body.size) : stiffness;
  return key("gap", gap) + key("stiffness", factor) + (is_hertz ? "law = \"hertz\"\n" : "") +
         damping(body, stiffness, is_hertz, random);
}

std::string load(const std::string& node, const std::string& dof, const std::string& course) {
  return "[[load]]\nnode = \"" + node + "\"\ndof = \"" + dof + "\"\n" + course;
}

std::string harmonic(double force, double omega, double phase) {
  return "type = \"harmonic\"\n" + key("amplitude", force) + key("angular_frequency", omega) + key("phase", phase);
}

std::string held(const std::string& node, const Body& body, Random& random) {
  std::string text = mass_text(node, body.mass);
  const double damping = random.chance(0.7) ? random.decades(-3.0, -0.5) * std::sqrt(body.stiffness * body.mass) : 0.0;
  for (const char* dof : {"uy", "uz"})
    text += spring_text("node = \"" + node + "\"\ndof = \"" + dof + "\"\n",
                        body.stiffness * (random.chance(0.3) ? random.uniform(0.5, 2.0) : 1.0), damping);
  return text;
}

std::string ring(const std::string& where, const Body& body, bool turns, Random& random) {
  const double gap = body.size * random.decades(-0.5, 0.2);
  double stiffness = 0.0;
  std::string text = "[[contact]]\ntype = \"ring\"\n" + where + law(body, gap, stiffness, random);
  if (random.chance(0.3)) text += pair("centre", 0.5 * gap * random.uniform(-1, 1), 0.5 * gap * random.uniform(-1, 1));
  if (random.chance(0.8)) text += friction(body, stiffness, Stick::not_rigid, !turns, random);
  return text + (turns ? key("radius", body.size * random.decades(0.0, 1.5)) : "");
}

/// A rotor in a ring, which may be fixed or carried by another body.
std::string rotor(const Body& body, Random& random) {
  std::string text = held("rotor", body, random), where = "nodes = \"rotor\"\n";
  if (random.chance(0.35)) {
    Body stator = body;
    stator.mass *= random.decades(-1.0, 1.0);
    stator.stiffness *= random.decades(-0.5, 1.5);
    text += held("stator", stator, random);
    where = "between = [\"rotor\", \"stator\"]\n";
  }
  const bool turns = random.chance(0.7);
  const double speed = body.omega() * random.uniform(0.3, 1.5), force = body.stiffness * body.size;
  if (turns)
    text += "[[element]]\ntype = \"disc\"\nnode = \"rotor\"\n" + key("mass", 0.1 * body.mass) + "[rotation]\n" +
            key("speed", speed) + "[[load]]\ntype = \"unbalance\"\nnode = \"rotor\"\n" +
            key("moment", force / (speed * speed) * random.decades(-0.5, 0.5));
  else
    text += load("rotor", "uy", harmonic(force * random.decades(-0.3, 0.5), speed, 0.3)) +
            load("rotor", "uz", harmonic(force * random.decades(-0.3, 0.5), 0.8 * speed, 1.1));
  return text + ring(where, body, turns, random);
}

/// A shaft of several elements in rings.
std::string shaft(const Body& body, Random& random) {
  constexpr double kYoung = 2e11, kDensity = 7800.0, kSteelSpeed = 5000.0;
  // Length from the frequency of a pinned beam whose radius is a fiftieth of it.
  const double length = std::pow(2.0 * kQuarterTurn, 2) * kSteelSpeed / (100.0 * body.omega()), radius = length / 50.0;
  const int elements = random.integer(1, 2) * 2;
  Body local = body;
  local.mass = kDensity * 2.0 * kQuarterTurn * radius * radius * length * 0.5;
  local.stiffness = local.mass * body.omega() * body.omega();
  std::string text = "[material.s]\n" + key("young_modulus", kYoung) + key("density", kDensity) +
                     "[section.c]\nshape = \"circle\"\n" + key("radius", radius) +
                     "[[element]]\ntype = \"beam\"\nname = \"b\"\nmotion = \"lateral\"\ntheory = \"rayleigh\"\n"
                     "material = \"s\"\nsection = \"c\"\n" +
                     key("length", length) + "elements = " + std::to_string(elements) +
                     "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"uy\", \"uz\"]\n[damping]\n" +
                     key("stiffness_proportional", random.decades(-2.5, -1.0) / body.omega());
  const double speed = body.omega() * random.uniform(0.3, 1.3), force = local.stiffness * body.size;
  const bool turns = random.chance(0.7);
  if (turns)
    text += "[rotation]\n" + key("speed", speed) + "[[load]]\ntype = \"unbalance\"\nnode = \"b:1\"\n" +
            key("moment", force / (speed * speed) * random.decades(-0.3, 0.7));
  else
    text += load("b:1", "uy", harmonic(force, speed, 0.3)) + load("b:1", "uz", harmonic(force, 0.8 * speed, 1.1));
  return text +
         ring(elements == 2 ? "nodes = \"b:1\"\n" : "nodes = [\"b:1\", \"b:2\", \"b:3\"]\n", local, turns, random);
}

/// A block pressed on a plane and pushed along it.
std::string block(const Body& body, Random& random) {
  double stiffness = 0.0;
  const double weight = body.stiffness * body.size * random.decades(-0.5, 0.5);
  std::string text = mass_text("m", body.mass) + spring_text("node = \"m\"\ndof = \"uy\"\n", body.stiffness, 0.0) +
                     spring_text("node = \"m\"\ndof = \"uz\"\n", 0.01 * body.stiffness, 0.0);
  text += "[[contact]]\ntype = \"plane\"\nnodes = \"m\"\n";
  const double angle = random.chance(0.4) ? random.uniform(-0.5, 0.5) : 0.0;
  text += pair("normal", std::sin(angle), std::cos(angle)) +
          law(body, random.chance(0.5) ? 0.0 : 0.3 * body.size, stiffness, random);
  text += friction(body, stiffness, Stick::any, true, random);
  return text + load("m", "uz", "type = \"constant\"\n" + key("value", weight)) +
         load("m", "uy", harmonic(weight * random.decades(-0.7, 0.3), body.omega() * random.decades(-0.5, 0.3), 0.4));
}

/// Masses in a row, some with friction supports or dissipating stops.
std::string row(const Body& body, Random& random) {
  const int count = random.integer(1, 3);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const std::string name = "m" + std::to_string(i), before = "m" + std::to_string(i - 1);
    text += mass_text(name, body.mass * random.decades(-0.5, 0.5)) +
            spring_text(i == 0 ? "node = \"m0\"\n" : "nodes = [\"" + before + "\", \"" + name + "\"]\n", body.stiffness,
                        random.chance(0.5) ? 0.01 * std::sqrt(body.stiffness * body.mass) : 0.0);
  }
  const std::string last = "m" + std::to_string(count - 1);
  const double force = body.stiffness * body.size;
  text += load(last, "uy", harmonic(force, body.omega() * random.decades(-0.5, 0.3), random.uniform(-1.5, 1.5)));
  if (random.chance(0.7))
    text += "[[contact]]\ntype = \"friction\"\nnodes = \"m0\"\n" +
            key("normal_force", force * random.decades(-1.0, 0.5)) +
            friction(body, body.stiffness, Stick::any, true, random);
  double stiffness = 0.0;
  std::string stop = "[[contact]]\ntype = \"stop\"\nnodes = \"" + last + "\"\n";
  if (count > 1 && random.chance(0.4)) stop = "[[contact]]\ntype = \"stop\"\nbetween = [\"m0\", \"" + last + "\"]\n";
  const std::array<const char*, 3> sides = {"both", "positive", "negative"};
  stop += std::string("sides = \"") + sides[static_cast<std::size_t>(random.integer(0, 2))] + "\"\n";
  return text + stop + law(body, body.size * random.decades(-1.0, 0.0), stiffness, random);
}

}  // namespace

Scene make(std::uint64_t seed) {
  Random random(seed * 32452843U + 11U);
  const Body body = random_body(random);
  Scene scene;
  scene.name = "rubbing ";
  scene.name += std::to_string(seed);
  const double kind = random.uniform(0.0, 1.0);
  scene.toml = "schema = 1\n" + (kind < 0.3    ? rotor(body, random)
                                 : kind < 0.5  ? shaft(body, random)
                                 : kind < 0.75 ? block(body, random)
                                               : row(body, random));
  scene.size = body.size;
  scene.end_time = random.uniform(1.0, 6.0) * 4.0 * kQuarterTurn / body.omega();
  scene.tolerance = random.decades(-7.0, -2.0);
  scene.step_factor = random.decades(-2.0, 0.0);
  return scene;
}

}  // namespace butee::stress::rubbing

namespace butee::stress {

Scene rubbing_scene(std::uint64_t seed) {
  return rubbing::make(seed);
}

}  // namespace butee::stress

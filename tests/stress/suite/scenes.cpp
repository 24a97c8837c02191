#include "scenes.hpp"

#include <algorithm>
#include <cmath>

#include <butee/core/text.hpp>

#include "scene_text.hpp"

namespace butee::stress {
namespace {

constexpr double kPi = 3.141592653589793;

/// Parameters of a mass on a spring with a stop and a load.
struct Recipe {
  double mass = 1.0, stiffness = 1e4, ratio = 0.02;  ///< kg, N/m, damping ratio
  double gap = 1e-3, stop = 1e6, lambda = 0.0;       ///< m, N/m, 1/m (0: the linear law)
  std::string sides = "both";
  double force = 2.0, tuning = 0.7;  ///< load amplitude over k size (0: no load), frequency over omega
  bool jumps = false;                ///< the load is switched on within a millionth of a period, and off again
  double start = 0.0, speed = 0.0;   ///< initial displacement and velocity, in units of size and omega size
  double periods = 6.0;

  double omega() const { return std::sqrt(stiffness / mass); }
  double size() const { return gap > 0.0 ? gap : 1e-3; }
};

std::string key(const char* name, double value) {
  return std::string(name) + " = " + to_text(value) + "\n";
}

std::string stop(const Recipe& r, const std::string& where) {
  std::string text = "[[contact]]\ntype = \"stop\"\n" + where + "sides = \"" + r.sides + "\"\n" + key("gap", r.gap) +
                     key("stiffness", r.stop);
  text += r.lambda > 0.0 ? "law = \"arctan\"\n" + key("regularization", r.lambda) : "law = \"linear\"\n";
  return text;
}

std::string load(const Recipe& r, const std::string& node, double force, double omega) {
  if (force == 0.0) return "";
  const std::string head = "[[load]]\nnode = \"" + node + "\"\n";
  if (!r.jumps)
    return head + "type = \"harmonic\"\n" + key("amplitude", force) + key("angular_frequency", r.tuning * omega);
  const double period = 2.0 * kPi / omega, on = 0.37 * period, off = 1.91 * period, edge = 1e-6 * period;
  return head + "type = \"table\"\ntimes = [0.0, " + to_text(on) + ", " + to_text(on + edge) + ", " + to_text(off) +
         ", " + to_text(off + edge) + "]\nvalues = [0.0, 0.0, " + to_text(force) + ", " + to_text(force) + ", " +
         to_text(-0.5 * force) + "]\n";
}

std::string initial(const std::string& nodes, double x, double v) {
  std::string text = "[initial]\n";
  if (x != 0.0) text += "displacement = [{nodes = \"" + nodes + "\", value = " + to_text(x) + "}]\n";
  if (v != 0.0) text += "velocity = [{nodes = \"" + nodes + "\", value = " + to_text(v) + "}]\n";
  return text;
}

Scene one_mass(const std::string& name, const Recipe& r) {
  Scene scene;
  scene.name = name;
  scene.size = r.size();
  scene.end_time = r.periods * 2.0 * kPi / r.omega();
  scene.toml = "schema = 1\n" + mass_text("m", r.mass) +
               spring_text("node = \"m\"\n", r.stiffness, 2.0 * r.ratio * std::sqrt(r.stiffness * r.mass)) +
               stop(r, "nodes = \"m\"\n") + load(r, "m", r.force * r.stiffness * r.size(), r.omega()) +
               initial("m", r.start * r.size(), r.speed * r.omega() * r.size());
  return scene;
}

/// Masses in a row, the first one connected to ground; the stop acts on the last one, or between the last
/// two.
Scene chain(const std::string& name, const Recipe& r, int count, bool between, bool with_dashpots, Random& random) {
  Scene scene;
  scene.name = name;
  scene.size = r.size();
  const bool couples_modes = with_dashpots && r.ratio > 0.0;
  const double c = couples_modes ? 2.0 * r.ratio * std::sqrt(r.stiffness * r.mass) : 0.0;
  scene.toml = "schema = 1\n";
  for (int i = 0; i < count; ++i) scene.toml += mass_text("m" + std::to_string(i), r.mass * random.decades(-0.5, 0.5));
  scene.toml += spring_text("node = \"m0\"\n", r.stiffness, c);
  for (int i = 1; i < count; ++i) {
    std::string ends = "nodes = [\"m";
    ends += std::to_string(i - 1) + "\", \"m" + std::to_string(i) + "\"]\n";
    scene.toml += spring_text(ends, r.stiffness * random.decades(-0.5, 0.5), c);
  }
  const std::string last = "m" + std::to_string(count - 1);
  scene.toml += stop(r, between ? "between = [\"m" + std::to_string(count - 2) + "\", \"" + last + "\"]\n"
                                : "nodes = \"" + last + "\"\n");
  scene.toml += load(r, last, r.force * r.stiffness * r.size(), r.omega());
  if (!couples_modes && r.ratio > 0.0)
    scene.toml += "[damping]\n" + (random.chance(0.5) ? key("mass_proportional", 2.0 * r.ratio * r.omega())
                                                      : key("stiffness_proportional", 2.0 * r.ratio / r.omega()));
  scene.toml += initial(last, r.start * r.size(), r.speed * r.omega() * r.size());
  scene.end_time = r.periods * 2.0 * kPi / r.omega();
  return scene;
}

/// A pinned steel pipe with stops at all nodes; its first frequency replaces omega.
Scene beam(const std::string& name, Recipe r, Random& random) {
  const int elements = 2 * random.integer(1, 3);
  const double length = random.decades(0.0, 1.3), radius = length * random.decades(-2.5, -1.5);
  const double omega = std::pow(kPi / length, 2) * std::sqrt(2e11 / 7900.0) * 0.5 * radius;
  const double stiffness = 48.0 * 2e11 * kPi / 4.0 * std::pow(radius, 4) / std::pow(length, 3);
  r.gap = r.gap > 0.0 ? length * random.decades(-5.0, -2.5) : 0.0;
  r.stop = std::clamp(stiffness * random.decades(-1.0, 5.0), 1e2, 1e14);
  Scene scene;
  scene.name = name;
  scene.size = r.gap > 0.0 ? r.gap : 1e-4 * length;
  scene.toml = "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\n" +
               key("radius", radius) +
               "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\n" +
               key("length", length) + "elements = " + std::to_string(elements) +
               "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n" + stop(r, "nodes = \"b:all\"\n") +
               load(r, "b:middle", r.force * stiffness * scene.size, omega);
  if (r.ratio > 0.0) scene.toml += "[damping]\n" + key("mass_proportional", 2.0 * std::min(r.ratio, 1.0) * omega);
  scene.toml += initial("b:middle", 0.0, r.speed * omega * scene.size);
  scene.end_time = 0.4 * r.periods * 2.0 * kPi / omega;
  return scene;
}

}  // namespace

std::uint64_t Random::next() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
}

double Random::decades(double low, double high) {
  return std::pow(10.0, uniform(low, high));
}

int Random::integer(int low, int high) {
  return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

Scene random_scene(std::uint64_t seed) {
  Random random(seed * 7919U + 17U);
  Recipe r;
  r.mass = random.decades(-6.0, 6.0);
  r.stiffness = random.decades(2.0, 14.0);
  const double damping = random.uniform(0.0, 1.0);
  r.ratio = damping < 0.3 ? 0.0 : damping < 0.85 ? random.decades(-4.0, -1.0) : random.decades(-0.5, 0.7);
  r.gap = random.chance(0.15) ? 0.0 : random.decades(-9.0, -1.0);
  r.stop = std::clamp(r.stiffness * random.decades(-2.0, 6.0), 1e2, 1e14);
  r.lambda = random.chance(0.3) ? random.decades(2.0, 14.0) : 0.0;
  const char* const sides[] = {"both", "both", "positive", "negative"};
  r.sides = sides[random.integer(0, 3)];
  r.force = random.chance(0.15) ? 0.0 : random.decades(-1.0, 1.0);
  r.tuning = random.chance(0.2) ? 1.0 : random.decades(-1.0, 0.5);
  r.jumps = random.chance(0.2);
  r.start = random.chance(0.2) ? random.uniform(-3.0, 3.0) : 0.0;
  r.speed = random.chance(0.4) || r.force == 0.0 ? random.uniform(-5.0, 5.0) : 0.0;
  r.periods = random.uniform(2.0, 8.0);
  std::string name = "random ";
  name += std::to_string(seed);
  const double kind = random.uniform(0.0, 1.0);
  Scene scene;
  if (kind < 0.45)
    scene = one_mass(name, r);
  else if (kind < 0.65)
    scene = chain(name, r, random.integer(2, 3), false, random.chance(0.3), random);
  else if (kind < 0.8)
    scene = chain(name, r, random.integer(2, 3), true, random.chance(0.3), random);
  else
    scene = beam(name, r, random);
  scene.tolerance = random.decades(-6.0, -2.0);
  scene.step_factor = random.decades(-3.0, 3.0);
  return scene;
}

std::vector<Scene> corner_scenes(int points) {
  std::vector<Scene> scenes;
  const auto sweep = [&](const std::string& what, double low, double high, auto change) {
    for (int i = 0; i < points; ++i) {
      const double exponent = points > 1 ? low + (high - low) * i / (points - 1) : low;
      const double value = std::pow(10.0, exponent);
      Recipe recipe;
      Scene extra;
      change(recipe, extra, value);
      Scene scene = one_mass(what + " 1e" + to_short_text(exponent), recipe);
      if (extra.step_factor != Scene{}.step_factor) scene.step_factor = extra.step_factor;
      scenes.push_back(std::move(scene));
    }
  };
  sweep("stiffness", 2, 14, [](Recipe& r, Scene&, double x) {
    r.stiffness = x;
    r.stop = std::min(100.0 * x, 1e14);
  });
  sweep("stop's stiffness", 2, 14, [](Recipe& r, Scene&, double x) { r.stop = x; });
  sweep("gap", -12, -1, [](Recipe& r, Scene&, double x) { r.gap = x; });
  sweep("lambda", 2, 14, [](Recipe& r, Scene&, double x) { r.lambda = x; });
  sweep("damping ratio", -6, 2, [](Recipe& r, Scene&, double x) { r.ratio = x; });
  sweep("step in critical steps", -3, 3, [](Recipe&, Scene& s, double x) { s.step_factor = x; });
  sweep("mass", -9, 9, [](Recipe& r, Scene&, double x) { r.mass = x; });
  sweep("resonance, force", -4, 2, [](Recipe& r, Scene&, double x) {
    r.tuning = 1.0;
    r.ratio = 0.0;
    r.force = x;
  });
  sweep("no gap, both sides, stop", 2, 14, [](Recipe& r, Scene&, double x) {
    r.gap = 0.0;
    r.stop = x;
  });
  sweep("no gap, arctan, lambda", 2, 14, [](Recipe& r, Scene&, double x) {
    r.gap = 0.0;
    r.lambda = x;
  });
  sweep("closed at the start, stop", 2, 14, [](Recipe& r, Scene&, double x) {
    r.start = 1.5;
    r.force = 0.3;
    r.stop = x;
  });
  sweep("load jumps, stop", 2, 14, [](Recipe& r, Scene&, double x) {
    r.jumps = true;
    r.stop = x;
  });
  return scenes;
}

}  // namespace butee::stress

#include "wide_body.hpp"

#include <algorithm>
#include <cmath>

#include <butee/core/text.hpp>

#include "scene_text.hpp"

namespace butee::stress {
namespace {

std::string coordinates(double length, int elements, Random& random) {
  std::vector<double> at = {0.0};
  for (int i = 0; i < elements; ++i) at.push_back(at.back() + random.uniform(0.3, 1.0));
  std::string text = "coordinates = [";
  for (const double x : at) text += to_text(length * x / at.back()) + (x == at.back() ? "" : ", ");
  return text + "]\n";
}

}  // namespace

const std::string& any_of(const std::vector<std::string>& all, Random& random) {
  return all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
}

Body row_of_masses(Random& random) {
  Body body;
  const int count = random.integer(1, 4);
  const bool is_tied = random.chance(0.85), is_uneven = random.chance(0.4), has_dashpots = random.chance(0.35);
  const double hardness = random.chance(0.3) ? random.decades(-2.0, 2.0) : 1.0;
  for (int i = 0; i < count; ++i) {
    const bool is_light = is_uneven && count > 1 && random.chance(0.5);
    const double m = random.decades(-0.4, 0.4) * (is_light ? random.decades(-8.0, 0.0) : 1.0);
    const std::string name = "m" + std::to_string(i);
    body.toml += mass_text(name, m);
    body.nodes.push_back(name);
    // Springs of light parts are scaled with their masses, so that frequencies cover at most four decades.
    const double k = 1e4 * hardness * random.decades(-0.7, 0.7) * (is_light ? std::sqrt(m) : 1.0);
    const double c = has_dashpots && random.chance(0.7) ? random.decades(-4.0, 0.3) * std::sqrt(k * m) : 0.0;
    const bool has_spring = i == 0 ? is_tied : random.chance(0.9);
    body.is_free = body.is_free || !has_spring;
    if (has_spring)
      body.toml += spring_text(
          i == 0 ? "node = \"" + name + "\"\n" : "nodes = [\"m" + std::to_string(i - 1) + "\", \"" + name + "\"]\n", k,
          c);
  }
  body.stiffness = 1e4 * hardness;
  body.omega = std::sqrt(body.stiffness);
  return body;
}

Body beams(Random& random) {
  Body body;
  const int count = random.integer(1, 3);
  double length = 0.0, flexibility = 0.0, mass = 0.0;
  std::vector<std::string> ends;
  for (int b = 0; b < count; ++b) {
    const std::string name = "b" + std::to_string(b), section = "s" + std::to_string(b);
    const int elements = random.integer(1, count == 1 ? 6 : 3);
    const double part = random.decades(-0.3, 0.3), radius = random.decades(-2.0, -1.4);
    body.toml += "[material.m" + name + "]\nyoung_modulus = " + to_text(2e11 * random.decades(-0.5, 0.2)) +
                 "\ndensity = " + to_text(random.uniform(2000.0, 9000.0)) + "\n[section." + section + "]\n" +
                 (random.chance(0.5) ? "shape = \"circle\"\nradius = " + to_text(radius)
                                     : "shape = \"tube\"\nouter_radius = " + to_text(radius) +
                                           "\ninner_radius = " + to_text(radius * random.uniform(0.2, 0.95))) +
                 "\n[[element]]\ntype = \"beam\"\nname = \"" + name + "\"\nmaterial = \"m" + name + "\"\nsection = \"" +
                 section + "\"\n" +
                 (random.chance(0.5) ? "length = " + to_text(part) + "\nelements = " + std::to_string(elements) + "\n"
                                     : coordinates(part, elements, random)) +
                 (b > 0 ? "start_node = \"b" + std::to_string(b - 1) + ":last\"\n" : "");
    length += part;
    flexibility += part / (2e11 * kQuarterTurn / 2.0 * std::pow(radius, 4));
    mass += part * 2.0 * kQuarterTurn * radius * radius * 6000.0;
    for (int i = b > 0 ? 1 : 0; i <= elements; ++i) body.nodes.push_back(name + ":" + std::to_string(i));
  }
  body.turning = body.nodes;
  body.stiffness = 3.0 / (flexibility * length * length);
  body.mass = 0.3 * mass;
  body.size = length * random.decades(-4.0, -2.0);
  // Cantilever, pinned, clamped and pinned, supported by springs only, or free.
  const double hold = random.uniform(0.0, 1.0);
  const std::string first = body.nodes.front(), last = body.nodes.back();
  const auto support = [&](const std::string& node, const char* fixed) {
    body.toml += "[[support]]\nnodes = [\"" + node + "\"]\nfix = [" + fixed + "]\n";
  };
  const auto drop = [&](std::vector<std::string>& from, const std::string& node) {
    from.erase(std::find(from.begin(), from.end(), node));
  };
  if (hold < 0.7) {
    const bool is_clamped = hold < 0.35;
    support(first, is_clamped ? "\"u\", \"theta\"" : "\"u\"");
    drop(body.nodes, first);
    if (is_clamped) drop(body.turning, first);
    // A single element between two pins moves only by its rotations; a stop has no place there.
    const bool has_two = body.nodes.size() > 1 && (!is_clamped || random.chance(0.4));
    if (has_two) {
      support(last, "\"u\"");
      drop(body.nodes, last);
      body.stiffness *= 12.0;
    }
  } else if (hold < 0.9) {
    for (const std::string& node : {first, last})
      body.toml +=
          spring_text("node = \"" + node + "\"\n", body.stiffness * random.decades(-1.0, 1.0),
                      random.chance(0.3) ? random.decades(-3.0, -0.5) * std::sqrt(body.stiffness * mass) : 0.0);
  } else {
    body.is_free = true;
  }
  const int discs = random.integer(0, 2);
  for (int i = 0; i < discs; ++i) {
    const double m = mass * random.decades(-3.0, 1.0);
    body.toml += "[[element]]\ntype = \"mass\"\nname = \"disc" + std::to_string(i) + "\"\nnode = \"" +
                 any_of(body.nodes, random) + "\"\nmass = " + to_text(m) +
                 "\nrotary_inertia = " + to_text(m * length * length * random.decades(-6.0, -1.0)) + "\n";
    body.mass += m;
  }
  const double bend = body.stiffness * length * length;
  if (random.chance(0.3))
    body.toml += spring_text(
        "node = \"" + any_of(body.turning, random) + "\"\ndof = \"theta\"\n", bend * random.decades(-3.0, 1.5),
        random.chance(0.5) ? 1e-2 * length * std::sqrt(bend * mass) * random.decades(-2.0, 0.0) : 0.0);
  if (body.turning.size() > 1 && random.chance(0.2))
    body.toml +=
        spring_text("nodes = [\"" + body.turning.front() + "\", \"" + body.turning.back() + "\"]\ndof = \"theta\"\n",
                    bend * random.decades(-3.0, 0.5), 0.0);
  body.omega = std::sqrt(body.stiffness / body.mass);
  return body;
}

void add_neighbour(Body& body, Random& random) {
  const double m = body.mass * random.decades(-4.0, 1.0);
  body.toml += mass_text("n", m);
  const bool is_tied = random.chance(0.7);
  body.is_free = body.is_free || !is_tied;
  if (is_tied) body.toml += spring_text("node = \"n\"\n", m * body.omega * body.omega * random.decades(-1.0, 1.0), 0.0);
}

Body flight(Random& random) {
  Body body;
  const double k = random.decades(0.0, 3.0);
  body.toml = mass_text("m0", 1.0) + spring_text("node = \"m0\"\n", k, random.chance(0.3) ? 0.01 * std::sqrt(k) : 0.0);
  body.nodes = {"m0"};
  body.size = 0.1;
  body.stiffness = k;
  body.omega = std::sqrt(k);
  const double gap = random.decades(-2.0, -0.5);
  body.toml += "[[contact]]\ntype = \"stop\"\nnodes = \"m0\"\ngap = " + to_text(gap) +
               "\nstiffness = " + to_text(std::min(1e10, k * random.decades(4.0, 8.0))) + "\nsides = \"" +
               (random.chance(0.7) ? "both" : "positive") + "\"\n";
  body.toml += random.chance(0.75)
                   ? "law = \"linear\"\n"
                   : "law = \"arctan\"\nregularization = " + to_text(random.decades(0.0, 6.0) / gap) + "\n";
  return body;
}

}  // namespace butee::stress

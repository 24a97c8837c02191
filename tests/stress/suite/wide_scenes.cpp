#include "wide_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <butee/core/text.hpp>

#include "scene_text.hpp"
#include "wide_body.hpp"

namespace butee::stress {
namespace {

/// gap, stiffness, sides and law of one stop.
std::string law(const Body& body, double gap, Random& random) {
  const bool is_hard = random.chance(0.25);
  const double stiffness = body.stiffness * (is_hard ? random.decades(3.0, 8.0) : random.decades(-1.0, 3.0));
  const char* const sides[] = {"both", "both", "positive", "negative"};
  std::string text = "gap = " + to_text(gap) + "\nstiffness = " + to_text(stiffness) + "\nsides = \"" +
                     sides[random.integer(0, 3)] + "\"\n";
  if (random.chance(0.6)) return text + "law = \"linear\"\n";
  return text +
         "law = \"arctan\"\nregularization = " + to_text(random.decades(0.0, 6.0) / (gap > 0.0 ? gap : body.size)) +
         "\n";
}

std::string stops(const Body& body, bool has_neighbour, Random& random) {
  std::string text;
  const int count = random.chance(0.05) ? 0 : random.integer(1, 3);
  const std::string favourite = any_of(body.nodes, random);
  for (int i = 0; i < count; ++i) {
    const double gap = random.chance(0.2) ? 0.0 : body.size * random.decades(-1.0, 0.3);
    std::string where = "nodes = \"" + (random.chance(0.5) ? favourite : any_of(body.nodes, random)) + "\"\n";
    if (has_neighbour && (i == 0 || random.chance(0.3))) {
      where = "between = [\"" + favourite + "\", \"n\"]\n";
    } else if (body.nodes.size() > 1 && random.chance(0.3)) {
      where = "between = [\"" + body.nodes.front() + "\", \"" + body.nodes.back() + "\"]\n";
    }
    text += "[[contact]]\ntype = \"stop\"\n" + where + law(body, gap, random);
  }
  return text;
}

std::string loads(const Body& body, Random& random) {
  std::string text;
  const int count = random.integer(0, 2);
  for (int i = 0; i < count; ++i) {
    const bool is_moment = !body.turning.empty() && random.chance(0.3);
    const double force = body.stiffness * body.size * random.decades(-1.0, 0.5) * (is_moment ? 0.3 : 1.0);
    const double period = 4.0 * kQuarterTurn / body.omega;
    text += "[[load]]\nnode = \"" + any_of(is_moment ? body.turning : body.nodes, random) + "\"\n" +
            (is_moment ? "dof = \"theta\"\n" : "");
    switch (random.integer(0, 6)) {
      case 0:
        text += "type = \"constant\"\nvalue = " + to_text(force) + "\n";
        break;
      case 1:
        text += "type = \"ramp\"\nto = " + to_text(force) + "\nstart = " + to_text(0.2 * period) +
                "\nend = " + to_text(period * (0.2 + random.decades(-9.0, 0.0))) + "\n";
        break;
      case 2: {
        const double speed = body.omega * random.decades(-0.5, 0.5);
        text += "type = \"unbalance\"\nmoment = " + to_text(force / (speed * speed)) + "\nspeed = " + to_text(speed) +
                "\nphase = " + to_text(random.uniform(0.0, 6.0)) + "\n";
        break;
      }
      case 3: {
        // A triangular load with an impulse of force/omega.
        const double width = random.decades(-10.0, -4.0), at = period * random.uniform(0.1, 1.5);
        text += "type = \"table\"\ntimes = [" + to_text(at) + ", " + to_text(at + width) + ", " +
                to_text(at + 2.0 * width) + "]\nvalues = [0.0, " + to_text(force / body.omega / width) + ", 0.0]\n";
        break;
      }
      case 4: {
        const double edge = period * random.decades(-9.0, -1.0), on = 0.37 * period, off = 1.91 * period;
        text += "type = \"table\"\ntimes = [" + to_text(on) + ", " + to_text(on + edge) + ", " + to_text(off) + ", " +
                to_text(off + edge) + "]\nvalues = [0.0, " + to_text(force) + ", " + to_text(force) + ", " +
                to_text(-0.5 * force) + "]\n";
        break;
      }
      default:
        text += "type = \"harmonic\"\namplitude = " + to_text(force) +
                "\nangular_frequency = " + to_text(body.omega * random.decades(-1.0, 0.7)) +
                "\nphase = " + to_text(random.uniform(-3.0, 3.0)) + "\n";
    }
  }
  return text;
}

std::string damping(const Body& body, Random& random) {
  const double ratio = random.decades(-4.0, -0.7);
  switch (random.integer(0, 6)) {
    case 0:
      return "[damping]\nmass_proportional = " + to_text(2.0 * ratio * body.omega) + "\n";
    case 1:
      return "[damping]\nmass_proportional = " + to_text(ratio * body.omega) +
             "\nstiffness_proportional = " + to_text(ratio / body.omega) + "\n";
    case 2:
      return "[damping]\nstiffness_proportional = " + to_text(ratio / body.omega) + "\n";
    case 3:
      // Rigid motion has no damping ratio.
      if (body.is_free) return "";
      return "[damping]\nmodal = " + to_text(ratio) + "\n";
    case 4:
      if (body.is_free) return "[damping]\nmodal = [0.0]\n";
      return "[damping]\nmodal = [" + to_text(ratio) + (body.nodes.size() > 1 ? ", " + to_text(0.3 * ratio) : "") +
             "]\n";
    default:
      return "";
  }
}

std::string start(const Body& body, bool has_neighbour, bool must_move, Random& random) {
  std::string place, speed;
  const auto add = [](std::string& to, const std::string& node, const char* dof, double value) {
    to += std::string(to.empty() ? "" : ", ") + "{ nodes = \"" + node + "\", dof = \"" + dof +
          "\", value = " + to_text(value) + " }";
  };
  if (random.chance(0.3)) add(place, body.nodes.back(), "u", body.size * random.uniform(-1.5, 1.5));
  if (must_move || random.chance(0.5))
    add(speed, body.nodes.back(), "u", body.size * body.omega * random.uniform(-3.0, 3.0));
  if (!body.turning.empty() && random.chance(0.15))
    add(speed, body.turning.front(), "theta", body.size * body.omega * random.uniform(-3.0, 3.0));
  if (has_neighbour && random.chance(0.5)) add(speed, "n", "u", body.size * body.omega * random.uniform(-2.0, 2.0));
  std::string text = "[initial]\n";
  if (!place.empty()) text += "displacement = [" + place + "]\n";
  if (!speed.empty()) text += "velocity = [" + speed + "]\n";
  return text;
}

}  // namespace

Scene wide_scene(std::uint64_t seed) {
  Random random(seed * 104729U + 71U);
  const double kind = random.uniform(0.0, 1.0);
  const bool is_flight = kind < 0.12;
  Body body = is_flight ? flight(random) : kind < 0.5 ? row_of_masses(random) : beams(random);
  const bool has_neighbour = !is_flight && kind >= 0.5 && random.chance(0.25);
  if (has_neighbour) add_neighbour(body, random);
  if (!is_flight) body.toml += stops(body, has_neighbour, random);
  const std::string load = loads(body, random);
  body.toml += load + damping(body, random) + start(body, has_neighbour, is_flight || load.empty(), random);
  Scene scene;
  scene.name = "wide ";
  scene.name += std::to_string(seed);
  scene.toml = "schema = 1\n" + body.toml;
  scene.size = body.size;
  const double periods = random.chance(0.1) ? random.decades(1.5, 3.0) : random.decades(0.0, 1.3);
  scene.end_time = periods * 4.0 * kQuarterTurn / body.omega;
  // Methods of order 2 refuse the smaller tolerances.
  scene.tolerance = random.chance(0.65) ? random.decades(-6.0, -2.0) : random.decades(-10.0, -6.0);
  scene.step_factor = random.decades(-2.0, 1.0);
  return scene;
}

std::optional<Scene> random_scene_of(const std::string& name) {
  for (const auto& [kind, make] : {std::pair{"random ", &random_scene}, std::pair{"wide ", &wide_scene},
                                   std::pair{"space ", &space_scene}, std::pair{"rubbing ", &rubbing_scene}}) {
    const std::string start = kind, number = name.starts_with(start) ? name.substr(start.size()) : "";
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos)
      return make(std::stoull(number));
  }
  return std::nullopt;
}

}  // namespace butee::stress

#include "support/small_scenes.hpp"

namespace butee::test {
namespace {

constexpr const char* kIntegrator = R"(
[integrator]
type = "rk4"
time_step = 0.1
end_time = 1.0
)";

std::string mass(const std::string& name, const std::string& kilograms) {
  return "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + kilograms + "\n";
}

}  // namespace

std::string mass_on_spring(const std::string& stiffness, const std::string& more) {
  return "schema = 1\n" + mass("m", "1.0") + "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = " + stiffness +
         "\n" + more + kIntegrator;
}

std::string two_masses(const std::string& more) {
  return "schema = 1\n" + mass("a", "4.0") + mass("b", "1.0") + more + kIntegrator;
}

std::string masses_in_stops(const std::string& more) {
  return two_masses(R"(
[[element]]
type = "spring"
node = "a"
stiffness = 8.0
[[element]]
type = "spring"
nodes = ["a", "b"]
stiffness = 3.0
[[contact]]
type = "stop"
nodes = ["a", "b"]
gap = 0.1
stiffness = 400.0
)" + more);
}

std::string TurningPipe::scene(const std::string& more) const {
  return R"(
schema = 1
[material.steel]
young_modulus = 2.03e11
density = 7900.0
poisson_ratio = 0.3
[section.pipe]
shape = "tube"
outer_radius = 0.06
inner_radius = 0.04
[rotation]
speed = 30.0
[[element]]
type = "beam"
theory = "rayleigh"
material = "steel"
section = "pipe"
name = ")" +
         name + "\"\nmotion = \"" + motion + "\"\nlength = " + length + "\nelements = " + std::to_string(elements) +
         "\n[[support]]\nnodes = [\"" + name + ":first\", \"" + name +
         ":last\"]\nfix = [\"uy\", \"uz\"]\n[[contact]]\ntype = \"ring\"\nnodes = \"" + name + ":all\"\ngap = " + gap +
         "\nstiffness = 1e6\nradius = 0.06\nfriction = { coefficient = 0.2, slip_speed = " + slip_speed +
         " }\n[[load]]\ntype = \"unbalance\"\nnode = \"" + name + ":middle\"\nmoment = " + unbalance + "\n" + more;
}

}  // namespace butee::test

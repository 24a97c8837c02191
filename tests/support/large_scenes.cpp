#include "support/large_scenes.hpp"

namespace butee::test {
namespace {

constexpr const char* kHead = R"(schema = 1

[material.steel]
young_modulus = 2.03e11
density       = 7900.0

[section.pipe]
shape        = "tube"
outer_radius = 0.06
inner_radius = 0.04

[damping]
mass_proportional = 0.03

[integrator]
type      = "newmark"
time_step = 1.0e-4
end_time  = 1.0

[integrator.newmark]
residual_tolerance  = 1.0e-7
increment_tolerance = 1.0e-7
max_iterations      = 10
)";

constexpr int kTiedNode = 10;

std::string in_quotes(const std::string& text) {
  return "\"" + text + "\"";
}

/// A beam with its supports, its stop and its load.
std::string beam(const std::string& name, int elements) {
  const std::string middle = in_quotes(name + ":" + std::to_string(elements / 2));
  return "\n[[element]]\ntype = \"beam\"\nname = " + in_quotes(name) +
         "\nmaterial = \"steel\"\nsection = \"pipe\"\nlength = " + std::to_string(elements) +
         ".0\nelements = " + std::to_string(elements) + "\n\n[[support]]\nnodes = [" + in_quotes(name + ":first") +
         ", " + in_quotes(name + ":last") + "]\nfix = [\"u\"]\n\n[[contact]]\ntype = \"stop\"\nnodes = " + middle +
         "\ngap = 1.0e-3\nlaw = \"linear\"\nstiffness = 1.0e7\n\n[[load]]\ntype = \"harmonic\"\nnode = " + middle +
         "\namplitude = 1.0e5\nangular_frequency = 62.8\n";
}

std::string tie(const std::string& a, const std::string& b) {
  return "\n[[element]]\ntype = \"spring\"\nnodes = [" + in_quotes(a) + ", " + in_quotes(b) + "]\nstiffness = 1.0e5\n";
}

std::string name_of(int beam) {
  return "b" + std::to_string(beam);
}

}  // namespace

std::string long_beam(int elements) {
  return kHead + beam(name_of(0), elements);
}

std::string tied_beams(int elements) {
  std::string scene = kHead;
  for (int i = 0; i < kTiedBeams; ++i) scene += beam(name_of(i), elements);
  for (int i = 0; i + 1 < kTiedBeams; ++i)
    for (int node = kTiedNode; node < elements; node += kTiedNode)
      scene += tie(name_of(i) + ":" + std::to_string(node), name_of(i + 1) + ":" + std::to_string(node));
  return scene;
}

}  // namespace butee::test

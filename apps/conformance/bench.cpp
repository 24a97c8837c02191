#include "apps/conformance/bench.hpp"

#include <cmath>

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::conformance {

namespace {

scene::Scene read(const plugin::Catalogue& catalogue, const std::string& scene,
                  const std::vector<std::string>& overrides) {
  config::Document document = config::parse_toml(scene, "the suite's scene");
  for (const std::string& assignment : overrides) config::apply_override(document, assignment);
  return scene::read_scene(std::move(document), catalogue, scene::Output::ignored);
}

}  // namespace

Bench::Bench(const plugin::Catalogue& catalogue, const std::string& scene, const std::vector<std::string>& overrides)
    : scene_(read(catalogue, scene, overrides)), assembly_(scene_) {}

Index Bench::dof(const std::string& selector) const {
  const auto selection = scene_.model.nodes.select(selector);
  require(selection.nodes.size() == 1, "a selector of one node");
  return system().dofs.index({selection.nodes.front(), DofKind::u});
}

time::State Bench::initial_state() {
  time::State state;
  state.x = system().initial_displacement;
  state.v = system().initial_velocity;
  integrator().start(state);
  return state;
}

std::string integrator_table(const std::string& name, const std::string& keys, double time_step, double end_time) {
  std::string table = "[integrator]\ntype = \"" + name + "\"\n";
  table += "time_step = " + to_text(time_step) + "\n";
  table += "end_time = " + to_text(end_time) + "\n";
  return table + keys;
}

std::string integrator_table(const Subject& subject, double time_step, double end_time) {
  return integrator_table(subject.name, subject.keys, time_step, end_time);
}

std::string rattling_beam(int elements, const std::string& law, const std::string& damping) {
  std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = 0.02\n"
      "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements = ";
  scene += std::to_string(elements);
  scene +=
      "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
      "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\n";
  scene += law;
  scene +=
      "[[load]]\ntype = \"harmonic\"\nnode = \"b:middle\"\namplitude = 500.0\nangular_frequency = 60.0\n"
      "[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n[damping]\n";
  return scene + damping;
}

std::string rattling_beam(const Subject& subject) {
  return rattling_beam(6, contact_law(subject), kRayleighDamping) + integrator_table(subject, kStep, kEnd);
}

bool takes(const Subject& subject, const std::string& scene) {
  try {
    Bench(subject.catalogue, scene);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string contact_law(const Subject& subject) {
  return takes(subject, rattling_beam(6, kBentLaw, kRayleighDamping) + integrator_table(subject, 1e-5, 1e-2)) ||
                 !takes(subject, rattling_beam(6, kLinearLaw, kRayleighDamping) + integrator_table(subject, 1e-5, 1e-2))
             ? kBentLaw
             : kLinearLaw;
}

std::vector<std::string> accept_all(const Subject& subject) {
  constexpr double kEverything = 1e30;
  for (const config::Parameter& p : subject.catalogue.find(subject.name)->declaration.parameters)
    if (p.name == "tolerance" && !subject.catalogue.find(subject.name)->declaration.fixed_step)
      return {"integrator.tolerance=" + to_text(std::min(p.upper, kEverything))};
  return {};
}

}  // namespace butee::conformance

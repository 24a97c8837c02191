#include "assembly.hpp"

#include <butee/core/error.hpp>

#include "perturb.hpp"

namespace butee::app {
namespace {

model::System assemble_perturbed(const model::Model& model, double perturbation) {
  model::System system = assemble(model);
  if (perturbation != 0.0) perturb(system.initial_displacement, perturbation);
  return system;
}

std::unique_ptr<time::Integrator> make(Session& session, dynamics::Dynamics& dynamics) {
  const plugin::IntegratorChoice& choice = session.integrator;
  auto made = session.catalogue.load(choice.name).make(choice.parameters, dynamics);
  if (made == nullptr)
    throw RunError(session.catalogue.find(choice.name)->module + ": made no method for \"" + choice.name + "\"");
  return made;
}

}  // namespace

Assembly::Assembly(Session& session, double perturbation)
    : system(assemble_perturbed(session.model, perturbation)),
      dynamics(system),
      integrator(make(session, dynamics)),
      simulation(dynamics, *integrator, session.integrator.options) {}

}  // namespace butee::app

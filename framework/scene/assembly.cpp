#include "butee/scene/assembly.hpp"

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_dashpots.hpp"
#include "butee/dynamics/static_position.hpp"

namespace butee::scene {
namespace {

/// The message of a method that rejects the scene, "integrator.type: ...", with the line of the
/// key.
std::string located(const config::Document& document, const std::string& message) {
  const config::Table* root = document.root.table();
  const config::Value* integrator = root != nullptr ? root->find("integrator") : nullptr;
  if (!message.starts_with("integrator.type: ") || integrator == nullptr || integrator->table() == nullptr)
    return message;
  const config::Value* type = integrator->table()->find("type");
  return describe(document, type != nullptr ? type->at : integrator->at) + ": " + message;
}

model::System assemble_changed(const model::Model& model, const std::function<void(model::System&)>& change) {
  model::System system = assemble(model);
  dynamics::make_modal_damping_explicit(model, system);
  if (change) change(system);
  if (model.starts_static) {
    dynamics::Dynamics dynamics(system);
    system.initial_displacement = static_position(dynamics, system.initial_time, system.initial_displacement);
  }
  return system;
}

}  // namespace

std::unique_ptr<time::Integrator> make_integrator(Scene& scene, dynamics::Dynamics& dynamics) {
  const IntegratorChoice& choice = scene.integrator;
  const auto made_or_located = [&] {
    try {
      return scene.catalogue.load(choice.name).make(choice.parameters, dynamics);
    } catch (const InputError& error) {
      throw InputError(located(scene.document, error.what()));
    }
  };
  auto made = made_or_located();
  if (made == nullptr)
    throw RunError(scene.catalogue.find(choice.name)->module + ": made no method for \"" + choice.name + "\"");
  return made;
}

Assembly::Assembly(Scene& scene, const std::function<void(model::System&)>& change)
    : system(assemble_changed(scene.model, change)),
      dynamics(system),
      integrator(make_integrator(scene, dynamics)),
      simulation(dynamics, *integrator, scene.integrator.options) {}

}  // namespace butee::scene

#include "butee/scene/assembly.hpp"

#include <exception>
#include <new>
#include <string_view>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/modal_dashpots.hpp"
#include "butee/dynamics/static_position.hpp"
#include "butee/scene/able_methods.hpp"

namespace butee::scene {
namespace {

/// The message of a method that rejects the scene, "integrator.KEY: ...", with the line of the key and its value, if it
/// is a number.
std::string located(const config::Document& document, const std::string& message) {
  const std::string_view before = "integrator.";
  const config::Table* root = document.root.table();
  const config::Value* integrator = root != nullptr ? root->find("integrator") : nullptr;
  const std::size_t colon = message.find(": ");
  if (!message.starts_with(before) || colon == std::string::npos || integrator == nullptr ||
      integrator->table() == nullptr)
    return message;
  const config::Value* value = integrator->table()->find(message.substr(before.size(), colon - before.size()));
  if (value == nullptr) return describe(document, integrator->at) + ": " + message;
  const double* number = std::get_if<double>(&value->data);
  return describe(document, value->at) + ": " + message.substr(0, colon) +
         (number != nullptr ? " = " + to_short_text(*number) : "") + message.substr(colon);
}

model::System assemble_changed(const model::Model& model, const std::function<void(model::System&)>& change) {
  model::System system = dynamics::assemble_to_run(model);
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
  const auto refusal = [&](const std::string& reason) {
    const std::vector<std::string> able = able_methods(scene, dynamics);
    return InputError(located(scene.document, reason + (able.empty() ? "" : "; these can: " + join(able))));
  };
  const time::IntegratorType& type = scene.catalogue.load(choice.name);
  if (const ContactNeeds needs = contact_needs(scene.model); type.contacts < needs.support)
    throw refusal("integrator.type: " + choice.name + " cannot treat " + needs.words);
  std::unique_ptr<time::Integrator> made;
  try {
    made = type.make(choice.parameters, dynamics);
  } catch (const InputError& error) {
    const std::string reason = error.what();
    if (reason.starts_with("integrator.type: ") || reason.starts_with("integrator.tolerance: ")) throw refusal(reason);
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const std::exception& error) {
    throw RunError(scene.catalogue.find(choice.name)->module + ": making the method \"" + choice.name +
                   "\" failed: " + error.what());
  } catch (...) {
    throw RunError(scene.catalogue.find(choice.name)->module + ": making the method \"" + choice.name +
                   "\" failed: it threw an exception that is not a std::exception");
  }
  if (made == nullptr)
    throw RunError(scene.catalogue.find(choice.name)->module + ": made no method for \"" + choice.name + "\"");
  return made;
}

AssembledEquations::AssembledEquations(const model::Model& model, const std::function<void(model::System&)>& change)
    : system(assemble_changed(model, change)), dynamics(system) {}

Assembly::Assembly(Scene& scene, const std::function<void(model::System&)>& change)
    : AssembledEquations(scene.model, change),
      integrator(make_integrator(scene, dynamics)),
      simulation(dynamics, *integrator, scene.integrator.options) {}

}  // namespace butee::scene

#include "butee/scene/able_methods.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::scene {
namespace {

/// The part of the run that a method with a fixed step takes as its step, if the scene has none.
constexpr double kStep = 1e-3;
/// Larger systems take seconds to try all methods on; only the one that chooses among them is tried.
constexpr Index kTried = 2000;
constexpr const char* kAutomatic = "auto";

/// The value of a parameter for a trial; nothing if its default serves, or if there is none.
std::optional<config::Value> value_for(const config::Parameter& parameter, const IntegratorChoice& choice) {
  const auto number = [](double value) { return config::Value(value); };
  if (parameter.name == "end_time") return number(choice.options.end_time);
  if (parameter.name == "time_step") {
    if (!parameter.required) return std::nullopt;
    return number(choice.options.time_step > 0.0 ? choice.options.time_step : kStep * choice.options.end_time);
  }
  if (parameter.name == "tolerance" && choice.parameters.has("tolerance"))
    return number(choice.parameters.number("tolerance"));
  if (!parameter.required || parameter.fallback) return std::nullopt;
  if (parameter.first_try) return parameter.first_try;
  return parameter.swept ? std::optional(number(parameter.swept->first)) : std::nullopt;
}

bool accepts(const time::IntegratorType& type, const IntegratorChoice& choice,
             const std::vector<config::Parameter>& all, dynamics::Dynamics& dynamics) {
  config::Table given;
  for (const config::Parameter& parameter : all)
    if (auto value = value_for(parameter, choice)) {
      if (!parameter.complaint(*value).empty()) return false;
      given[parameter.name] = std::move(*value);
    }
  try {
    return type.make(config::make_parameters(all, given), dynamics) != nullptr;
  } catch (const InputError&) {
    return false;
  } catch (const RunError&) {
    return false;
  }
}

}  // namespace

ContactNeeds contact_needs(const model::Model& model) {
  using time::ContactSupport;
  ContactNeeds needs{ContactSupport::elastic_stops, "contacts in the plane, with dissipation or friction"};
  for (const model::ObstacleGroup& group : model.obstacles) {
    needs.support = std::max(needs.support, ContactSupport::without_memory);
    if (group.friction.rule == model::Friction::Rule::spring)
      needs = {std::max(needs.support, ContactSupport::without_rigid),
               "friction with a stick spring, whose memory ends steps where it sticks and slips"};
    if (group.friction.rule == model::Friction::Rule::rigid) return {ContactSupport::all, "friction with rigid stick"};
  }
  return needs;
}

std::vector<std::string> able_methods(Scene& scene, dynamics::Dynamics& dynamics) {
  const ContactNeeds needs = contact_needs(scene.model);
  std::vector<std::string> able;
  for (const std::string& name : scene.catalogue.integrator_names()) {
    const plugin::IntegratorEntry& entry = *scene.catalogue.find(name);
    const bool is_alias = name != entry.declaration.name;
    if (is_alias || name == scene.integrator.name || (dynamics.size() > kTried && name != kAutomatic)) continue;
    const std::vector<config::Parameter> parameters = parameters_of(entry);
    const time::IntegratorType& type = scene.catalogue.load(name);
    if (type.contacts >= needs.support && accepts(type, scene.integrator, parameters, dynamics)) able.push_back(name);
  }
  return able;
}

}  // namespace butee::scene

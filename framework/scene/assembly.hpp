#pragma once

#include <functional>
#include <memory>

#include "butee/scene/read_scene.hpp"

namespace butee::scene {

/// The equations of motion of a model, which need no method.
struct BUTEE_EXPORT AssembledEquations {
  /// `change` may alter the system, such as its initial values, before it is used. `model` must outlive this object.
  explicit AssembledEquations(const model::Model& model, const std::function<void(model::System&)>& change = {});

  model::System system;
  dynamics::Dynamics dynamics;
};

/// An assembled scene with its method and a simulation without observers.
struct BUTEE_EXPORT Assembly : AssembledEquations {
  /// Throws InputError if the scene cannot be run, and RunError if its module violates its
  /// declaration. `scene` must outlive this object.
  explicit Assembly(Scene& scene, const std::function<void(model::System&)>& change = {});

  std::unique_ptr<time::Integrator> integrator;
  time::Simulation simulation;
};

/// The method of a scene for a system. Throws as Assembly does.
BUTEE_EXPORT std::unique_ptr<time::Integrator> make_integrator(Scene& scene, dynamics::Dynamics& dynamics);

}  // namespace butee::scene

#pragma once

#include <memory>

#include <butee/time/simulation.hpp>

#include "session.hpp"

namespace butee::app {

/// A scene assembled, with its method and a simulation that nobody watches yet.
struct Assembly {
  /// `perturbation` (m or rad) is added to the initial displacements, with a fixed pattern of signs and sizes. Throws
  /// InputError where the scene cannot be run, and RunError where its module does not keep what it promised. `session`
  /// must outlive it.
  explicit Assembly(Session& session, double perturbation = 0.0);

  model::System system;
  dynamics::Dynamics dynamics;
  std::unique_ptr<time::Integrator> integrator;
  time::Simulation simulation;
};

}  // namespace butee::app

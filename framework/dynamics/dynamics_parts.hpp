#pragma once

#include <optional>

#include "butee/core/blocks.hpp"
#include "butee/core/zeros.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/external_forces.hpp"
#include "butee/dynamics/internal_forces.hpp"
#include "butee/dynamics/rigid_sticks.hpp"

namespace butee::dynamics {

/// The private parts of Dynamics.
struct Dynamics::Parts {
  explicit Parts(const model::System& system);

  linalg::Counters counters{};
  ElasticStops stops;
  std::unique_ptr<Obstacles> obstacles;  ///< null if there are none
  ExternalForces loads;
  InternalForces internal;
  std::optional<RigidSticks> sticks;  ///< with rigid friction
  std::optional<linalg::LinearSolver> mass_solver{};
  std::optional<EffectiveSolver> effective{};
  std::unique_ptr<ModalSystem> modal{};
  std::vector<bool> has_stops, has_loads{};  ///< of each block of rows
  Vector contact_force, stop_displacement, stop_velocity, stop_force, stick_acceleration{};
};

}  // namespace butee::dynamics

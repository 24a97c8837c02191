#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/model/base_motion.hpp"
#include "butee/model/contact_law.hpp"
#include "butee/model/dofs.hpp"
#include "butee/model/element.hpp"
#include "butee/model/free_play.hpp"
#include "butee/model/nodes.hpp"
#include "butee/model/obstacle.hpp"
#include "butee/model/rotation.hpp"
#include "butee/model/time_function.hpp"

namespace butee::model {

/// Elastic stops of one law and gap: F = -s K_c(g) g on node a with the side s and the penetration g of FreePlay.
struct StopGroup {
  std::unique_ptr<ContactLaw> law;
  FreePlay play;
  DofKind dof = DofKind::uy;
  std::vector<NodeId> a;
  std::vector<NodeId> b;  ///< empty: stops to ground; else as long as `a`
};

/// A load: a pattern (N or N m per unit of the time function) times a function of time.
struct Load {
  std::vector<NodalValue> pattern;
  std::unique_ptr<TimeFunction> in_time;
  const Element* line = nullptr;  ///< the element of a line load, whose section forces it enters; else null
  double per_length = 0.0;        ///< N/m, for a line load
  DofKind along = DofKind::uy;    ///< the displacement direction of a line load
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< acceleration of a pattern M r, along x, y and z; else 0
};

/// An initial motion of all free DOFs, in the order of DofTable::free().
struct InitialMotion {
  Vector displacement, velocity;  ///< m or rad, m/s or rad/s
  double time = 0.0;              ///< s, at which the run starts
  Vector contact = {};            ///< state of the contacts (time::contact_memory), or empty
};

/// Rayleigh damping, C = mass_proportional M + stiffness_proportional K, or modal damping, C = M
/// Phi diag(2 zeta_i omega_i) Phi^T M with the modes of the undamped system with open stops.
/// Dashpots are added to it.
struct Damping {
  /// The largest number of damped modes: all modes are dense matrices, and in much finer meshes
  /// rounding cannot distinguish the lowest modes from rigid motion.
  static constexpr Index kMostModes = 1000;

  double mass_proportional = 0.0;       ///< 1/s
  double stiffness_proportional = 0.0;  ///< s
  double every_mode = 0.0;              ///< zeta of all modes, 1 = critical
  std::vector<double> lowest_modes;     ///< zeta of the lowest modes; the others are not damped

  bool is_rayleigh() const { return mass_proportional != 0.0 || stiffness_proportional != 0.0; }
  bool is_modal() const { return every_mode != 0.0 || !lowest_modes.empty(); }
};

/// The content of a scene before assembly. Built by read_model() or in code.
struct Model {
  std::string title;
  NodeTable nodes;
  std::vector<std::unique_ptr<Element>> elements;
  std::vector<std::string> element_names;  ///< names of `elements`, "" for one without a name; may be shorter
  std::vector<NodalDof> fixed;
  std::vector<StopGroup> stops;
  std::vector<ObstacleGroup> obstacles;
  std::vector<Load> loads;
  Damping damping;
  std::unique_ptr<Rotation> rotation;           ///< null if nothing turns
  std::vector<bool> turns;                      ///< for each of `elements`, whether it turns; may be shorter
  std::vector<BaseMotion> bases;                ///< motions of the supports; `loads` contains their forces
  BaseFrame base_frame = BaseFrame::moving;     ///< reference of x
  bool starts_static = false;                   ///< start at rest in the static position under the initial loads
  double rotating_damping = 0.0;                ///< s: stiffness-proportional damping that turns with the turning parts
  std::optional<InitialMotion> initial_motion;  ///< from an earlier run; the values below replace parts of it
  std::vector<NodalValue> initial_displacement;
  std::vector<NodalValue> initial_velocity;
};

/// M r: the forces (N, N m) that accelerate every mass by `acceleration` (m/s2 along x, y, z), node
/// by node, without those on fixed DOFs.
BUTEE_EXPORT std::vector<NodalValue> inertia_pattern(const Model& model, const Eigen::Vector3d& acceleration);

/// The DOFs that the elements claim, numbered after the supports are applied.
BUTEE_EXPORT DofTable number_dofs(const Model& model);

}  // namespace butee::model

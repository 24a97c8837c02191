#pragma once

#include <array>
#include <string>
#include <vector>

#include "butee/model/model.hpp"

namespace butee::model {

/// Stops of one law on free DOFs, as arrays. Stop i acts on w_i = x[a_i] - x[b_i].
struct FreeStops {
  static constexpr Index kGround = -1;

  const ContactLaw* law = nullptr;
  FreePlay play;
  std::vector<Index> a;  ///< index into x, or kGround where that end is fixed
  std::vector<Index> b;  ///< likewise

  std::size_t size() const { return a.size(); }
};

/// Obstacles of one group on free DOFs.
struct FreeObstacles {
  /// Free DOFs of a contact along its directions, or FreeStops::kGround. The third of `a` is the rotation rx of a node
  /// that friction at a radius twists.
  struct Ends {
    std::array<Index, 3> a, b;
  };

  const ObstacleGroup* group = nullptr;
  std::vector<Ends> ends;
  std::vector<std::string> names;  ///< "rotor" or "rotor|casing", as long as `ends`
};

/// A load on free DOFs: F[dof_i] += weight_i * in_time(t).
struct FreeLoad {
  std::vector<Index> dofs;
  std::vector<double> weights;
  const TimeFunction* in_time = nullptr;
};

/// The semi-discrete system M a + C v + K x = F(t) + F_c(x) on the n free DOFs,
/// C = mass_proportional M + stiffness_proportional K + D, or modal damping + D.
///
/// M, K (and D where there are dashpots, else 0 x 0) are stored in full, with one common, symmetric pattern that holds
/// the diagonal and the places of stops between nodes. M is symmetric; K and D are where is_symmetric says so.
///
/// Parts that turn at the speed Omega add Omega G (gyroscopic, skew) to D and, where damping turns with them, Omega W
/// to K. At a constant speed D and K hold these; otherwise `rotation` is set and C(t) = C + Omega(t) G, K(t) = K +
/// Omega(t) W + Omega'(t) G. Rayleigh damping is proportional to K without W and G: D makes up for it.
///
/// The Model must outlive its System and stay where it is.
struct System {
  explicit System(DofTable table) : dofs(std::move(table)) {}

  Index size() const { return mass.rows(); }

  DofTable dofs;
  SparseMatrix mass, stiffness, dashpots;
  bool is_symmetric = true;              ///< K and D
  bool stiffness_is_symmetric = true;    ///< K
  SparseMatrix gyroscopic, circulatory;  ///< G, kg m2 ..., and W, N s/m ...; 0 x 0 where none or the speed is constant
  const Rotation* rotation = nullptr;    ///< set where its speed varies and G or W is there
  Damping damping;
  std::vector<FreeLoad> loads;
  std::vector<FreeStops> stops;
  std::vector<FreeObstacles> obstacles;
  Vector initial_displacement, initial_velocity;
  double initial_time = 0.0;     ///< s
  const Model* model = nullptr;  ///< that it was assembled from; null for a part of a system
  Index skipped_stops = 0;       ///< stops whose ends are all fixed
  Index skipped_loads = 0;       ///< loads that vanish at all times
};

/// Where the matrices of parts that turn go: into D and K, at the speed of the model, or apart, into `gyroscopic` and
/// `circulatory`, D and K being those of rest.
enum class TurningParts { included, apart };

/// Assembles the model. Throws InputError that names the node where a free DOF has no mass, a loaded DOF is fixed or
/// absent, or nothing is free to move.
BUTEE_EXPORT System assemble(const Model& model, TurningParts turning = TurningParts::included);

/// Takes the stops, loads and initial motion of another model with the same nodes, elements and supports, so that M, K
/// and D stay. False, and nothing changed, where they act on other DOFs, or by other weights; then assemble() is due.
/// The model that the system was assembled from must stay beside the new one.
BUTEE_EXPORT bool replace_loads(const Model& model, System& system);

}  // namespace butee::model

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
  /// Free DOFs of a contact along its directions, or FreeStops::kGround. The third is the rotation rx of a node on
  /// which friction acts with an arm.
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
/// M, K (and D if there are dashpots, else 0 x 0) are stored in full, with one common, symmetric
/// pattern that includes the diagonal and the entries of stops between nodes. M is symmetric; K and
/// D are symmetric if is_symmetric is true.
///
/// Parts that turn at the speed Omega add Omega G (gyroscopic, skew) to D and, for damping that
/// turns with them, Omega W to K. At a constant speed D and K include these terms; otherwise
/// `rotation` is set and C(t) = C + Omega(t) G, K(t) = K + Omega(t) W + Omega'(t) G. Rayleigh
/// damping is proportional to K without W and G: D contains the correction.
///
/// The Model must outlive its System and must not be moved.
struct System {
  explicit System(DofTable table) : dofs(std::move(table)) {}

  Index size() const { return mass.rows(); }

  DofTable dofs;
  SparseMatrix mass, stiffness, dashpots;
  bool is_symmetric = true;              ///< for K and D
  bool stiffness_is_symmetric = true;    ///< for K
  SparseMatrix gyroscopic, circulatory;  ///< G, kg m2 ..., and W, N s/m ...; 0 x 0 if absent or if the speed is
                                         ///< constant
  const Rotation* rotation = nullptr;    ///< set if its speed varies and G or W exists
  Damping damping;
  std::vector<FreeLoad> loads;
  std::vector<FreeStops> stops;
  std::vector<FreeObstacles> obstacles;
  Vector initial_displacement, initial_velocity;
  Vector initial_contact;        ///< state of the contacts (time::contact_memory), or empty
  double initial_time = 0.0;     ///< s
  const Model* model = nullptr;  ///< the model it was assembled from; null for a part of a system
  Index skipped_stops = 0;       ///< stops whose ends are all fixed
  Index skipped_loads = 0;       ///< loads that vanish at all times
};

/// Destination of the matrices of turning parts: included in D and K at the speed of the model, or
/// kept apart in `gyroscopic` and `circulatory`, with D and K those at rest.
enum class TurningParts { included, apart };

/// Assembles the model. Throws InputError naming the node if a free DOF has no mass, a loaded DOF
/// is fixed or absent, or nothing is free to move.
BUTEE_EXPORT System assemble(const Model& model, TurningParts turning = TurningParts::included);

/// The contacts of `obstacles` in their order, "ring disc 1 2 5", with the numbers of the directions and of the rule of
/// friction, as an assembly of the model has them.
BUTEE_EXPORT std::vector<std::string> contact_names(const Model& model, const DofTable& dofs);

/// Takes the stops, loads and initial motion of another model with the same nodes, elements and
/// supports; M, K and D are kept. If they act on other DOFs or with other weights, returns false
/// and changes nothing; assemble() is then required. The original model of the system must stay
/// alive in addition to the new one.
BUTEE_EXPORT bool replace_loads(const Model& model, System& system);

}  // namespace butee::model

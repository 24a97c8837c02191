#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "butee/model/contact_law.hpp"
#include "butee/model/dofs.hpp"

namespace butee::model {

/// Position of a body with displacement d = (d_1, d_2) relative to an obstacle.
struct Approach {
  double penetration;      ///< g(d), m; negative while apart
  Eigen::Vector2d normal;  ///< dg/dd, of length 1: into the obstacle
  double curvature;        ///< 1/m: d2g/dd2 = curvature t t^T with the tangent t = (-normal_2, normal_1)
};

/// The shape of an obstacle in the plane of one or two displacements of a node (or of their difference between two).
class BUTEE_EXPORT ContactShape {
 public:
  virtual ~ContactShape() = default;
  virtual Approach at(const Eigen::Vector2d& d) const = 0;

  /// Properties needed by methods that expand the motion in series, and by friction with a stick spring.
  struct Form {
    enum class Kind { line, circle, other } kind = Kind::other;
    Eigen::Vector2d place = {0.0, 0.0};  ///< the normal of a line, or the centre of a circle (m)
    double distance = 0.0;               ///< g = normal . d - distance, or sense (|d - centre| - distance), m
    double sense = 1.0;                  ///< +1: the body is inside the circle, -1: it is outside
  };
  virtual Form form() const { return {}; }
};

/// Dissipation of a closed contact, with g' the rate of penetration.
struct ImpactDamping {
  enum class Kind {
    none,
    kelvin_voigt,   ///< F = K_c(g) g + c g', c in N s/m
    hunt_crossley,  ///< F = K_c(g) g (1 + a g'), a in s/m
    jankowski,      ///< F = K_c(g) g + 2 xi sqrt(K_c(g) m) g' while g' > 0; xi = c
    law             ///< F = ContactLaw::rated_force(g, g')
  };
  Kind kind = Kind::none;
  double coefficient = 0.0;  ///< c, a or xi
  double mass = 0.0;         ///< m of jankowski, kg
  bool pulls = false;        ///< kelvin_voigt: true if the contact ends at g = 0, false if it ends at F = 0
};

/// Coulomb friction: the tangential force on the body is -mu F_n s with the slip speed w.
struct Friction {
  enum class Rule {
    none,
    sqrt,    ///< s = w/sqrt(w^2 + slip_speed^2)
    tanh,    ///< s = tanh(w/slip_speed)
    clip,    ///< s = w/slip_speed within [-1, 1]
    spring,  ///< stick: spring and dashpot from the point where it began, up to static_coefficient F_n; then slip
    rigid    ///< stick: w = 0 up to static_coefficient F_n; then slip
  };
  Rule rule = Rule::none;
  double coefficient = 0.0, static_coefficient = 0.0;  ///< mu of slip and of stick
  double slip_speed = 0.0;                             ///< m/s
  double stick_stiffness = 0.0, stick_damping = 0.0;   ///< N/m, N s/m
  double surface_speed = 0.0;                          ///< m/s, of the obstacle along the tangent

  bool has_memory() const { return rule == Rule::spring || rule == Rule::rigid; }
};

/// Contacts of one kind in one or two directions, with dissipation and friction; elastic stops are
/// in StopGroup.
///
/// The force on node a (against ground, or against node b: d = d_a - d_b) is
///
///     F = -F_n n - F_t t,    F_t = mu F_n s(w),
///     w = t . d' + arm_a rx_a' - arm_b rx_b' + turning Omega - surface_speed
///
/// with the normal n and the tangent t = (-n_2, n_1) of the shape. A friction support has no shape:
/// F_n is `normal_force` and t is its one direction. Nodes that have the rotation rx get the torques
/// -arm_a F_t and arm_b F_t.
struct ObstacleGroup {
  std::string kind;                     ///< kind name in the scene, "ring"
  std::unique_ptr<ContactLaw> law;      ///< null if there is no shape
  std::unique_ptr<ContactShape> shape;  ///< null: a friction support
  double normal_force = 0.0;            ///< N, of a friction support
  std::vector<DofKind> directions;      ///< one or two displacements
  ImpactDamping damping;
  Friction friction;
  /// m: from the bodies' centres to the contact point along n; negative against the order of the
  /// directions. The displacement of the centres against each other is that at the gap.
  double arm_a = 0.0, arm_b = 0.0;
  double turning = 0.0;  ///< m: slip speed over the speed of [rotation]; of the arms of the bodies that turn
  std::vector<NodeId> a;
  std::vector<NodeId> b;  ///< empty: against ground; else as long as `a`

  /// Whether friction exerts torques about x.
  bool twists() const { return friction.rule != Friction::Rule::none && (arm_a != 0.0 || arm_b != 0.0); }
};

}  // namespace butee::model

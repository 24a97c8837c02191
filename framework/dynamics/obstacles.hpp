#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "butee/linalg/counters.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The phase of a contact. Within a phase its force is a smooth function of the motion.
struct ContactPhase {
  enum class Normal : std::uint8_t {
    apart,     ///< g < 0
    released,  ///< g > 0, but the dissipative law would give a tensile force
    pressed,   ///< a force acts
    receding,  ///< a force acts and g' < 0; only for laws that distinguish approach from rebound
    pulling    ///< tensile F_n < 0 of a dashpot, in a contact with friction: no friction acts
  };
  enum class Slip : std::uint8_t {
    smooth,   ///< no friction, or the steep part of a smooth law, |w| <= k slip_speed
    stick,    ///< or, for a clipped law, its linear part
    forward,  ///< slip with w > 0
    backward,
    ahead,  ///< the flat part w > k slip_speed of a smooth law
    behind  ///< the flat part w < -k slip_speed
  };
  /// k for sqrt and for tanh. A step that crosses the steep part entirely could miss it, so a step
  /// ends where that part begins. A Taylor series about a point where tanh is 1 to rounding does
  /// not represent the other side of tanh.
  static constexpr double kSteep = 4.0, kSteepOfTanh = 20.0;
  Normal normal = Normal::apart;
  Slip slip = Slip::smooth;
  double anchor = 0.0;  ///< m: path of the slip at which a stick spring is unstressed
  double angle = 0.0;   ///< rad: angle of the arm in a ring from which the path is measured

  bool touches() const { return normal == Normal::pressed || normal == Normal::receding; }
  friend bool operator==(const ContactPhase&, const ContactPhase&) = default;
};

/// Kinematics, forces and stored energy of a contact at an instant.
struct ContactForces {
  double penetration = 0.0;            ///< g, m; 0 for a friction support
  double rate = 0.0;                   ///< g', m/s
  double normal = 0.0;                 ///< F_n, N
  double friction = 0.0;               ///< F_t = mu F_n s, N, against the slip
  double slip_speed = 0.0;             ///< w, m/s
  double surface = 0.0;                ///< the part of w that is not motion of the nodes, m/s
  double stored = 0.0;                 ///< J: energy of the normal law (0 at g = 0) and of a stick spring
  bool is_released = false;            ///< ContactPhase::Normal::released: no force although g > 0
  Eigen::Vector2d force = {0.0, 0.0};  ///< on node a along its directions, N

  /// The forces along Obstacles::Coordinates.
  Eigen::Vector3d along_all() const { return {force[0], force[1], -friction}; }
};

/// The contacts of a system that have two directions, dissipation or friction, one after the other.
///
/// Each is evaluated in its phase: either in the phase given to follow(), whose force is continued
/// beyond the end of the phase, or "live", in the phase that follows from the present motion. Laws
/// with memory need given phases. Checked against closed forms in tests/verification/ring_test.cpp,
/// friction_test.cpp and impact_damping_test.cpp, and by differences in
/// tests/unit/obstacles_test.cpp.
class BUTEE_EXPORT Obstacles {
 public:
  /// The coordinates of a contact, m: its two directions, and the slip by the rotations rx of its nodes, arm_a rx_a -
  /// arm_b rx_b.
  using Coordinates = Eigen::Vector3d;
  using Block = Eigen::Matrix3d;
  /// Far from a ring with a stick spring, at its centre, the slip does not matter; the lever gap/r of the spring is at
  /// most this, so that it stays finite.
  static constexpr double kMostLever = 2.0;
  /// Entries of State::contact for each contact.
  static constexpr Index kStateSize = 4;
  /// Entries of memory() for each contact.
  static constexpr Index kMemorySize = 3;
  /// The largest number of switching functions of a contact.
  static constexpr std::size_t kMostSwitches = 5;

  /// `system` and `counters` must outlive this object.
  Obstacles(const model::System& system, linalg::Counters& counters);

  Index size() const { return static_cast<Index>(contacts_.size()); }
  /// n, the free DOFs of the system.
  Index system_size() const { return system_->size(); }
  const model::ObstacleGroup& group_of(Index i) const { return *at(i).group; }
  const std::string& name_of(Index i) const { return *at(i).name; }
  const model::FreeObstacles::Ends& ends_of(Index i) const { return *at(i).ends; }
  /// The free DOFs of all contacts, without repetition, ascending.
  const std::vector<Index>& dofs() const { return dofs_; }
  /// True if a contact sticks rigidly in some phase, so that its force follows from the motion of
  /// the structure.
  bool has_rigid_friction() const { return has_rigid_friction_; }

  /// Sets the phases of all contacts, kStateSize numbers each.
  void follow(ConstVectorRef phases);
  void follow_live() { is_live_ = rubs_ = true; }
  /// The same without the forces of friction, for a static position.
  void follow_live_without_friction() { is_live_ = true, rubs_ = false; }
  ContactPhase phase(Index i) const { return phases_[static_cast<std::size_t>(i)]; }
  void set_phase(Index i, const ContactPhase& phase) { phases_[static_cast<std::size_t>(i)] = phase; }
  bool is_live() const { return is_live_; }

  /// force += the forces of all contacts at the motion (x, v), except rigid sticking.
  void add_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force);
  ContactForces forces(Index i, double t, ConstVectorRef x, ConstVectorRef v) const;
  /// The sum of ContactForces::stored, J.
  double energy(double t, ConstVectorRef x, ConstVectorRef v) const;

  /// The phase of a contact that follows from the motion at an instant alone. A stick spring is
  /// then unstressed.
  ContactPhase phase_at(Index i, double t, ConstVectorRef x, ConstVectorRef v) const;
  /// The memory of contact i in `phase`: the numbers of its normal and slip phase and the stretch
  /// of its stick spring, m. Unlike an anchor, the stretch depends neither on the time nor on the
  /// path of the surface.
  Eigen::Vector3d memory(Index i, const ContactPhase& phase, double t, ConstVectorRef x, ConstVectorRef v) const;
  /// phase_at(), with slip and stretch from `memory` if the contact touched then and touches now.
  ContactPhase phase_after(Index i, const Eigen::Vector3d& memory, double t, ConstVectorRef x, ConstVectorRef v) const;
  /// A switching function of a phase, positive within it, and the phase it leads to.
  struct Switch {
    double value;
    ContactPhase to;
  };
  /// Uncertainty by rounding of the displacement, m, and velocity, m/s, at a contact; `of_speed` is that of its rate of
  /// penetration by errors of the motion, as a fraction of the speed of the contact.
  struct Rounding {
    double displacement = 0.0, velocity = 0.0, of_speed = 0.0;
  };
  /// The switching functions of the phase of contact i. They are 0 where their sign is rounding. `held` is the
  /// tangential force that holds a rigid stick, N; `a` is read only if switches_by_acceleration(i). Returns their
  /// number.
  std::size_t switches(Index i, double t, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, double held,
                       const Rounding& rounding, std::array<Switch, kMostSwitches>& out) const;
  /// True if the slip of contact i ends at a motion that depends on accelerations: a stick spring with
  /// a dashpot beside it or beside the normal law.
  bool switches_by_acceleration(Index i) const;
  /// The same phase with the arc of a stick spring measured from the present angle of the arm, so
  /// that the contact may go around the ring any number of times.
  ContactPhase rebased(Index i, const ContactPhase& phase, ConstVectorRef x) const;
  /// d_i and its velocity, and the slip by rotations with its rate.
  struct Motion {
    Eigen::Vector2d d, v;
    double rolled, rolling;
  };
  Motion motion(Index i, ConstVectorRef x, ConstVectorRef v) const;
  /// True if a contact is apart at x by more than rounding; false for shapes other than lines and
  /// circles.
  bool is_apart(Index i, ConstVectorRef x) const { return is_apart(at(i), gather(i, x).head<2>()); }
  /// False if a motion from one to the other within h seconds stays apart: both ends are farther
  /// away than the distance covered at both speeds, which a cubic through them exceeds by 4/27 at
  /// most.
  bool may_touch(Index i, const Motion& from, const Motion& to, double h) const;

  /// -dF/dd, -dF/dd' and dF/dt of a contact, N/m, N s/m, N/s.
  struct Tangent {
    Index contact;
    Block stiffness, damping;
    Coordinates rate;
  };
  /// For the contacts that exert a force, in their phases.
  const std::vector<Tangent>& tangents(double t, ConstVectorRef x, ConstVectorRef v);

  /// Contacts that stick rigidly now; each has a constraint T v = b(t), with the row T along its
  /// tangent t.
  std::vector<Index> rigid_sticks() const;
  /// The slip speed of a line or a friction support per unit velocity of the coordinates.
  Coordinates tangent_of(Index i) const;
  /// db/dt, m/s2
  double surface_acceleration(Index i, double t) const;
  /// True if friction acts on a free rotation.
  bool twists(Index i) const { return ends_of(i).a[2] >= 0 || ends_of(i).b[2] >= 0; }
  /// force += value T^T
  void scatter(Index i, const Coordinates& value, VectorRef force) const;
  Coordinates gather(Index i, ConstVectorRef y) const;
  /// Calls entry(i, j, value) for the entries of S^T block S on the free DOFs.
  template <class Entry>
  void visit(Index contact, const Block& block, Entry entry) const {
    const model::FreeObstacles::Ends& ends = ends_of(contact);
    for (std::size_t p = 0; p < 6; ++p)
      for (std::size_t q = 0; q < 6; ++q) {
        const Index i = p < 3 ? ends.a[p] : ends.b[p - 3], j = q < 3 ? ends.a[q] : ends.b[q - 3];
        if (i < 0 || j < 0) continue;
        const double value =
            weight(contact, p) * block(static_cast<Index>(p % 3), static_cast<Index>(q % 3)) * weight(contact, q);
        if (value != 0.0) entry(i, j, value);
      }
  }
  /// The largest stiffness of a closed contact, N/m, along its first direction.
  double closed_stiffness(Index i) const;

 private:
  struct Contact {
    const model::ObstacleGroup* group;
    const model::FreeObstacles::Ends* ends;
    const std::string* name;
    model::ContactShape::Form form;
    double rest_energy = 0.0;       ///< of the law at d = 0, J
    double reach = 0.0;             ///< m: Form::distance with a margin for rounding, for is_apart()
    bool is_silent_apart = false;   ///< no force acts while apart
    bool has_round_spring = false;  ///< a ring whose friction has a stick spring
  };
  /// Position of a contact and its slip.
  struct Kinematics {
    Motion motion;
    model::Approach approach;
    Eigen::Vector2d tangent;
    double rate, slip, surface;
    double lever;  ///< of the friction: slip speed over that of the body's point, see lever_of()
  };
  struct Normal {
    double force, elastic, by_penetration, by_rate;
  };
  /// s(w) of a smooth or clipped rule, or of a slip phase, and its derivative.
  struct Slide {
    double share, slope;
  };

  class SwitchList;

  /// Of DOF p, 0 to 2 of node a and 3 to 5 of node b, in the coordinate p % 3.
  double weight(Index contact, std::size_t p) const {
    const double of_a = p % 3 < 2 ? 1.0 : group_of(contact).arm_a, of_b = p % 3 < 2 ? 1.0 : group_of(contact).arm_b;
    return p < 3 ? of_a : -of_b;
  }
  const Contact& at(Index i) const { return contacts_[static_cast<std::size_t>(i)]; }
  Kinematics kinematics(Index i, double t, ConstVectorRef x, ConstVectorRef v) const;
  Normal normal(const Contact& contact, ContactPhase::Normal phase, double g, double rate) const;
  ContactPhase live_phase(const Contact& contact, const Kinematics& at) const;
  void add_normal_switches(const Contact& contact, const ContactPhase& phase, const Kinematics& now,
                           const Rounding& uncertainty, SwitchList& list) const;
  void add_slip_switches(Index i, const ContactPhase& phase, double t, const Kinematics& now, ConstVectorRef a,
                         double held, const Rounding& uncertainty, SwitchList& list) const;
  /// The normal force of a closed contact divided by the sum of the magnitudes of its terms: has
  /// its sign, and is regular at g = 0.
  double pressing_share(const Contact& contact, ContactPhase::Normal phase, double g, double rate) const;
  static Slide slide(const model::Friction& friction, ContactPhase::Slip phase, double w);
  /// A stick spring in a ring acts at the radius of the gap, so that its stretch is a function of the
  /// position: slip speed and tangential force are those at the body's distance r times gap/r. 1 for
  /// any other friction.
  static double lever_of(const Contact& contact, const Eigen::Vector2d& d) {
    return contact.has_round_spring ? contact.form.distance / (d - contact.form.place).norm() : 1.0;
  }
  /// The path of the slip since some origin: a function of the motion whose rate is the slip speed.
  /// For a ring it contains the arc from `angle`, the shorter way around.
  double path(Index i, double t, const Kinematics& at, double angle) const;
  /// The angle of the arm in a ring, rad; 0 for other contacts.
  double angle_of(Index i, const Kinematics& at) const;
  double friction_force(Index i, double t, const Kinematics& at, const ContactPhase& phase, double normal) const;
  /// By how much a contact slips too fast to stick, m/s. It sticks with the tension T = k s + c w = mu F_n of slip
  /// where the spring could follow, k w + c max(0, w') <= mu F_n', with w in the sense of the slip: a larger tension
  /// would exceed mu F_n. The stretch s is then at least 0: c w <= mu F_n (contact/README.md).
  double excess_of_slip(Index i, double t, const Kinematics& at, const Normal& pressing, double sense,
                        ConstVectorRef a) const;
  /// True if no force acts because the contact is apart.
  bool is_idle(Index i, ConstVectorRef x) const {
    const Contact& contact = at(i);
    if (!contact.is_silent_apart) return false;
    return is_live_ ? is_apart(contact, gather(i, x).head<2>())
                    : phases_[static_cast<std::size_t>(i)].normal == ContactPhase::Normal::apart;
  }
  static bool is_apart(const Contact& contact, const Eigen::Vector2d& d);
  /// g at d, m.
  static double penetration(const Contact& contact, const Eigen::Vector2d& d);
  ContactPhase& used(Index i) { return phases_[static_cast<std::size_t>(i)]; }

  const model::System* system_;
  linalg::Counters* counters_;
  const model::Rotation* rotation_;
  std::vector<Contact> contacts_;
  std::vector<ContactPhase> phases_;
  std::vector<Tangent> tangents_;
  std::vector<Index> dofs_;
  bool is_live_ = true, rubs_ = true, has_rigid_friction_ = false;
};

}  // namespace butee::dynamics

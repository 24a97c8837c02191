#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/dynamics/effective_solver.hpp"
#include "butee/dynamics/elastic_stops.hpp"
#include "butee/dynamics/modal_system.hpp"
#include "butee/dynamics/obstacles.hpp"
#include "butee/linalg/force_balance.hpp"

namespace butee::dynamics {

/// Operations on the system M a + C v + K x = F(t) + F_c(x) for integrators.
///
/// If the speed of rotation varies, C and K are those of the last instant t that was asked for.
///
/// Matrices, factorizations and caches live here, never in an integrator. Each is made at its first
/// use, so that unused features cost nothing. Vectors have size(): displacements m or rad, forces N
/// or N m. Not thread-safe; each thread needs its own simulation.
class BUTEE_EXPORT Dynamics {
 public:
  /// `system` must outlive this object. Throws InputError if modes with modal damping could not be
  /// computed.
  explicit Dynamics(const model::System& system);
  ~Dynamics();
  Dynamics(const Dynamics&) = delete;
  Dynamics& operator=(const Dynamics&) = delete;

  const model::System& system() const { return system_; }
  Index size() const { return system_.size(); }
  Index stop_count() const { return stops_->size(); }
  /// All contacts: stops() and obstacles().
  Index contact_count() const { return stop_count() + (obstacles_ ? obstacles_->size() : 0); }
  bool has_damping() const;
  ElasticStops& stops() { return *stops_; }
  /// Contacts in the plane, with dissipation or friction; null if the scene has none.
  Obstacles* obstacles() { return obstacles_; }
  /// The forces that hold the rigidly sticking contacts at a motion, in the order of
  /// Obstacles::rigid_sticks(), N.
  const Vector& stick_forces(double t, ConstVectorRef x, ConstVectorRef v);
  /// The forces of every contact of obstacles() at a motion, including those that hold rigid
  /// sticks.
  void contact_forces(double t, ConstVectorRef x, ConstVectorRef v, std::vector<ContactForces>& all);
  /// force += the forces of all contacts at a motion, including those that hold rigid sticks, N or
  /// N m.
  void add_held_contact_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force);
  /// a += M^-1 T^T times the forces that hold the contacts that stick rigidly now, if any. Without t, `a` is a
  /// derivative of the acceleration.
  void hold_sticks(std::optional<double> t, VectorRef a);
  /// v := the velocity after the impulse that stops the sliding of the contacts that stick rigidly
  void stop_sliding(double t, VectorRef v);
  linalg::Counters& counters() { return *counters_; }
  const linalg::Counters& counters() const { return *counters_; }

  /// Sets C and K to those of an instant, if the speed of rotation varies.
  void set_time(double t);
  /// F := F(t)
  void external_force(double t, VectorRef force);
  /// Invalidates cached load values, after time functions of loads have changed.
  void loads_changed();
  /// To be called after model::replace_loads() has given the system the stops and loads of another
  /// model. Factorizations and modes are kept; otherwise the object is as if newly constructed.
  void loads_replaced();
  /// F := dF/dt(t), from the loads' Taylor series or, for loads without one, a difference over `h`
  /// s
  void external_force_rate(double t, double h, VectorRef rate);
  /// rate -= dC/dt v + dK/dt x at the last instant that was asked for; zero unless the speed of
  /// rotation varies
  void subtract_matrix_rate(ConstVectorRef x, ConstVectorRef v, VectorRef rate) const;
  /// F += F_c(x) of the stops
  void add_contact_force(ConstVectorRef x, VectorRef force);
  /// F += the forces of obstacles()
  void add_obstacle_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force) {
    if (obstacles_) obstacles_->add_force(t, x, v, force);
  }
  /// y := K x
  void elastic_force(ConstVectorRef x, VectorRef y) const;
  /// y := C v
  void damping_force(ConstVectorRef v, VectorRef y);
  /// y := M a
  void inertia_force(ConstVectorRef a, VectorRef y) const;

  /// r := F(t) + F_c(x) - C v - K x
  void total_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef r);
  /// The same at t + after. Where a load varies within a few spacings of the doubles its value does
  /// not depend on the rounding of t + after. No load discontinuity may lie between t and t + after.
  void total_force(double t, double after, ConstVectorRef x, ConstVectorRef v, VectorRef r);

  /// kappa and c, in stop space, of the secant law F_c = S^T (c - kappa S x) that equals F_c at x
  void secant_contact(ConstVectorRef x, VectorRef kappa, VectorRef c);
  /// a := the solution of (M + velocity_factor C + displacement_factor (K + S^T kappa S)) a =
  /// F(t) + S^T (c - kappa S x) - C v - K x: the equations of motion with the secant law then hold
  /// at x + displacement_factor a and v + velocity_factor a. False if the matrix is not positive
  /// definite.
  [[nodiscard]] bool solve_secant(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                                  ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a);

  /// r := F + F_c - M a - C v - K x, with F = `load` (zero if no load acts) and F_c given in stop
  /// space by `stop_force`. Returns |r| and its scale |F| + |F_c| + |M a| + |C v| + |K x|
  /// (2-norms).
  linalg::ForceBalance residual(ConstVectorRef load, ConstVectorRef stop_force, ConstVectorRef x, ConstVectorRef v,
                                ConstVectorRef a, VectorRef r);

  /// a := M^-1 (F(t) + F_c(x) - C v - K x)
  void acceleration(double t, ConstVectorRef x, ConstVectorRef v, VectorRef a);
  /// The same at t + after, as total_force().
  void acceleration(double t, double after, ConstVectorRef x, ConstVectorRef v, VectorRef a);
  /// a := M^-1 (a - C v - K x), with the forces given in a
  void solve_acceleration(ConstVectorRef x, ConstVectorRef v, VectorRef a);

  /// The effective equations of an implicit method.
  EffectiveSolver& effective();

  /// The system in its `count` lowest modes (0: ModalSystem chooses), computed at the first call.
  /// Throws InputError.
  ModalSystem& modal(Index count = 0);
  /// The instants at which a load or one of its derivatives jumps, ascending.
  std::vector<double> load_discontinuities() const;
  /// True if a load or the angular acceleration of the rotation itself jumps at t, by comparison with an instant
  /// before.
  bool loads_jump(double t) const;

  /// "u of string:17"
  std::string dof_name(Index dof) const;

 private:
  struct Parts;

  linalg::LinearSolver& mass_solver();
  bool solve_secant_of_many(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                            ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a);
  bool solve_single_secant(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                           ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a);
  /// a := M^-1 a minus the deceleration by the damping that InternalForces::subtract_from() omits
  void solve_mass(ConstVectorRef v, VectorRef a);

  const model::System& system_;
  std::unique_ptr<Parts> parts_;
  // Of the parts, for access without a call.
  linalg::Counters* counters_;
  ElasticStops* stops_;
  Obstacles* obstacles_;  ///< null if there are none
};

}  // namespace butee::dynamics

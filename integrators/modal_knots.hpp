#pragma once

#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/modal_motion.hpp"
#include "integrators/quintic.hpp"
#include "integrators/stop_path.hpp"

namespace butee::integrators {

/// cos and sin of a harmonic load at an instant.
struct Phase {
  double cosine, sine;
};

/// The forces of the stops over a step.
struct StepForces {
  bool is_free = true;            ///< there are none
  std::array<Vector, 3> moments;  ///< modal, of P_0, P_1 and P_2, as dynamics::ModalMotion takes them
  Vector standing;                ///< the pulls of stops out of contact, N
  std::vector<Index> touched;     ///< stops in contact, and of each stop:
  /// speed times h at both ends, bulge, what its speed may be wrong by (m/s), and force moments, which tell its path
  Eigen::ArrayXXd paths;
  enum Column : Index { kStartSpeed, kEndSpeed, kBulge, kFeltSpeed, kMoments, kColumns = kMoments + 3 };

  /// Divides them at a place of the step, the second part going to another. Not with stops in contact.
  void divide(double place, StepForces& second);
};

/// The instants between which a method took its steps in modal coordinates, and the motion between them, which is that
/// of the modes under the loads and the forces found in the step, as at its end.
class ModalKnots {
 public:
  /// The largest |int_0^s (F - P F) ds| of a force F that jumps by 1 within a step.
  static constexpr double kJump = 0.0625;

  /// For up to `most` steps. All must outlive it.
  ModalKnots(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, std::vector<StopForce>& stops,
             std::size_t most);

  /// `w`: the displacements of the stops.
  void begin(double t, const double* q, const double* v, const double* w);
  void add(double t, const double* q, const double* v, const double* w);

  /// To be filled once the step from a knot has been added.
  StepForces& forces(std::size_t knot) { return forces_[knot]; }

  double last() const { return times_.back(); }
  std::size_t steps() const { return times_.size() - 1; }
  double time(std::size_t knot) const { return times_[knot]; }
  /// Those strictly within.
  std::span<const double> inner() const;
  /// Of the harmonic loads, at a knot.
  std::span<const Phase> phases(std::size_t knot);

  /// The last knot not after t that a step begins at.
  std::size_t before(double t) const;
  const double* q(std::size_t knot) const { return q_.col(static_cast<Index>(knot)).data(); }
  const double* v(std::size_t knot) const { return v_.col(static_cast<Index>(knot)).data(); }
  const double* w(std::size_t knot) const { return w_.col(static_cast<Index>(knot)).data(); }

  /// The motion of the modes in the middle of the step from a knot.
  struct Modes {
    double t;
    const double *q, *v;
    std::span<const Phase> phases;
  };
  Modes middle_of(std::size_t knot);

  /// The motion of `dofs` at `times`, ascending.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);

 private:
  /// What the acceleration of a DOF takes from the modes, the loads and the forces of the stops.
  struct View {
    Index dof;
    Vector shape, of_q;  ///< padded for dynamics::ModalMotion
    Vector of_v, of_harmonics, of_loads, of_stops;
    std::vector<Motion> motions;  ///< at the knots
    std::vector<bool> is_known;
  };

  std::size_t view_of(Index dof);
  const Motion& motion_at(std::size_t knot, View& view);
  void find_stop_forces(std::size_t knot);
  /// Of a DOF at an instant, from its x, v and of_q . q, modal speeds, cos and sin of the loads and, where there are
  /// any, the forces of the stops.
  Motion motion_of(const View& view, double t, const std::array<double, 3>& products, const double* v,
                   std::span<const Phase> phases, const Vector* stop_forces) const;
  /// The motion of all modes within the step from a knot, and its accelerations.
  void find_within(std::size_t knot, double t);
  void find_contacts(std::size_t knot);
  void find_forces_within(std::size_t knot, double t);
  void find_phases_within(double t);

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  std::vector<StopForce>& stops_;
  dynamics::ModalMotion motion_;
  double single_decay_;  ///< of all modes alike, 1/s; negative where they differ
  std::vector<double> times_;
  Eigen::MatrixXd q_, v_, w_, stop_forces_;
  std::vector<bool> has_forces_, has_phases_;
  std::vector<Phase> phases_;
  std::vector<View> views_;
  std::vector<StepForces> forces_;
  std::vector<std::size_t> asked_;
  // Within a step.
  std::size_t begun_ = static_cast<std::size_t>(-1);  ///< the knot that motion_ begins at
  /// A stop in contact, by its moments along its path.
  struct Contact {
    Index stop;
    StopPath path;
    ForceMoments moments;
  };
  std::vector<Contact> closed_;    ///< whose moments tell their force in full
  std::vector<Contact> changing_;  ///< that open or close on the way, of whose force the moments are not enough
  Vector compliances_;             ///< of each stop for short times, |phi|^2, 1/kg
  Vector stop_forces_within_;
  std::vector<Phase> phases_within_;
};

}  // namespace butee::integrators

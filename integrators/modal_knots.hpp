#pragma once

#include <span>
#include <vector>

#include "butee/solve/dynamics.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// cos and sin of a harmonic load at an instant.
struct Phase {
  double cosine, sine;
};

/// The instants between which a method took its steps in modal coordinates, and the motion between them: quintics
/// through displacement, velocity and acceleration, laid only where somebody asks.
class ModalKnots {
 public:
  /// For up to `most` steps. Both must outlive it.
  ModalKnots(solve::Dynamics& dynamics, const solve::ModalSystem& modal, std::size_t most);

  /// `w`: the displacements of the stops.
  void begin(double t, const double* q, const double* v, const double* w);
  void add(double t, const double* q, const double* v, const double* w);

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

  /// The motion of `dofs` at `times`, ascending.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);

 private:
  /// What the acceleration of a DOF takes from the modes, the loads and the forces of the stops.
  struct View {
    Index dof;
    Vector of_q, of_v, of_harmonics, of_loads, of_stops;
    std::vector<Motion> motions;  ///< at the knots
    std::vector<bool> is_known;
  };

  std::size_t view_of(Index dof);
  const Motion& motion_at(std::size_t knot, View& view);
  void find_stop_forces(std::size_t knot);

  solve::Dynamics& dynamics_;
  const solve::ModalSystem& modal_;
  double single_decay_;  ///< of all modes alike, 1/s; negative where they differ
  std::vector<double> times_;
  Eigen::MatrixXd q_, v_, w_, stop_forces_;
  std::vector<bool> has_forces_, has_phases_;
  std::vector<Phase> phases_;
  std::vector<View> views_;
  std::vector<std::size_t> asked_;
  std::vector<Quintic> courses_;
};

}  // namespace butee::integrators

#pragma once

#include <vector>

#include "integrators/exponential/contact_dofs.hpp"
#include "integrators/exponential/force_errors.hpp"
#include "integrators/exponential/modal_loads.hpp"
#include "integrators/exponential/step_response.hpp"
#include "integrators/exponential/stop_borders.hpp"
#include "integrators/exponential/sweep_acceleration.hpp"
#include "integrators/exponential/varying_forces.hpp"
#include "integrators/local_error.hpp"

namespace butee::integrators {

/// The contact forces at the nodes of a step, with VaryingForces, and the motion of the damped modes under the
/// polynomials through these forces.
///
/// Sweeps compute both: forces at the nodes, motion at the nodes, forces again. Contacts keep the
/// phases that dynamics::Obstacles tracks; the displacement at a node determines if a stop is open
/// or closed there.
class NodeForces {
 public:
  /// Throws InputError for contacts that collocation cannot treat. Both must outlive it.
  NodeForces(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes);

  const ContactDofs& dofs() const { return dofs_; }
  const VaryingForces& varying() const { return varying_; }
  /// Bound of the difference between the motion of the contacts, without contact forces, and the
  /// polynomial through its values at the nodes, divided by the largest displacement scale of the
  /// contacts or, at a start, by what a mode reaches in the step.
  double unresolved(const time::State& from, const double* z, const ModalLoads& loads, double h) const;
  /// True if the displacements of contacts at modal coordinates `z` (2p numbers) are so small that none of them can act
  /// in a step at whose nodes they are that small.
  bool stays_apart(const double* z) const;
  /// The same for the motion at all nodes of the step found last.
  bool stays_apart() const;

  enum class Outcome { converged, diverged, not_finite };
  /// Computes the motion of a step from `from`; free_nodes() must hold its motion without contacts.
  /// Sweeps end if they change velocities by less than `settled`, relative to their scales.
  Outcome find(const time::State& from, const StepResponse& response, double settled);

  /// Ends the computed step, which begins at t with z, after the fraction `part` of its length, with
  /// the same forces. `loads` are the polynomials of other loads over the shorter step or null, and
  /// `response` is that to the end of the shorter step; nodes() remain unknown until find_nodes().
  /// Within the step the polynomials are not superconvergent; the error is the interpolation error.
  void end_at(double part, double t, const double* z, const double* loads, const PlaceResponse& response);
  /// Finds the motion at the nodes of the shortened step.
  void find_nodes(double t, const double* loads, const StepResponse& response);

  Lanes& free_nodes() { return free_; }
  const Lanes& nodes() const { return nodes_; }            ///< z at the nodes, 2p rows
  const Eigen::VectorXd& end() const { return end_; }      ///< z at the end
  const Lanes& polynomial() const { return polynomial_; }  ///< coefficients of 1, s, ..., s^6, 2p rows
  /// Error estimate of z at the end: z computed without the values in the middle of the step, minus
  /// z, plus the error of Lobatto's rule for the impulse of the forces.
  const Eigen::VectorXd& error() const { return error_; }
  /// The largest error of a contact's velocity within the step found last, which ends with `to`, relative to the scale
  /// of that velocity early in the step. At the end of the step the error is far smaller.
  double inner_error(const time::State& from, const time::State& to) const;
  /// True if steps end where contacts cross borders that are no changes of their phase.
  bool has_borders() const { return dynamics_.stops().size() > 0 || !inner_borders_.empty(); }
  /// The fraction of the step of length h from t after which a contact crosses one of these borders; range.last, which
  /// may slightly exceed 1, if none does. `is_still`: the structure rests, and crosses borders by rounding.
  double first_contact_change(double t, double h, const CrossingRange& range, bool is_still);

 private:
  using AtNodes = Eigen::Matrix<double, Eigen::Dynamic, StepNodes::kCount>;

  /// Takes the end from the nodes.
  Outcome finished();
  void start(const time::State& from, double h);
  /// Finds on which side of the middle the stops are whose force jumps there, by the motion at the start.
  void find_sides(const time::State& from, double h);
  /// Continues the forces of their sides beyond the middle.
  void keep_sides(const Vector& x, Vector& force) const;
  /// The displacement of a stop at the nodes.
  StepNodes::Row displacement_of(Index stop) const;
  /// At the nodes of the step of length h from t, m.
  StepNodes::Row penetration_of(Index obstacle, double t, double h);
  /// The weights of forces in the norm of the acceleration: their effects on the relative speeds.
  void find_weights(const time::State& from);
  /// Computes the forces at one node, and at all nodes except the start.
  void find_forces(double t, double h, Index node);
  void find_forces(double t, double h);
  void move(const StepResponse& response, const StepNodes::Matrix& coefficients);
  /// Adds the response at one position to the polynomial with these coefficients.
  void add_response(const PlaceResponse& response, const Lanes& polynomial, Eigen::VectorXd& out);
  void estimate(double t, const StepResponse& response);
  /// Sets the scales of displacements and velocities for change(). At a start from rest they are the speed that the
  /// acceleration causes within 1/omega of the contacts, and the way at that speed.
  void find_scales(const time::State& from, double h);
  /// The largest relative change of a velocity or displacement by the last sweep.
  double change(double h) const;

  /// A motion of the active DOFs only, and its forces.
  struct Instant {
    Vector x, v, force;
  };

  dynamics::Dynamics& dynamics_;
  const dynamics::DampedModes& modes_;
  VaryingForces varying_;
  ContactDofs dofs_;
  bool need_velocity_;
  StopBorders borders_;
  std::vector<std::pair<Index, double>> inner_borders_;  ///< of obstacles: inner_border(), m
  ForceErrors errors_;
  std::vector<double> sides_;  ///< of borders_.jumping() in the step
  ActiveDofs active_;
  Instant instant_;
  Lanes free_, nodes_, polynomial_, kept_nodes_, kept_polynomial_;
  Lanes missed_;              ///< polynomial_ computed without the values in the middle, minus polynomial_
  Lanes coefficients_, row_;  ///< of the forces; motion of the active DOFs
  Eigen::MatrixXd columns_;   ///< for add_response()
  AtNodes forces_, forces_before_, moved_, moved_velocity_, weights_;  ///< for the active DOFs
  SweepAcceleration acceleration_;
  Eigen::VectorXd end_, error_;
  ComponentScales scales_;
  std::vector<double> discontinuities_;  ///< instants at which a load or its slope jumps, s, ascending
  Vector scale_x_, scale_v_, work_;
};

}  // namespace butee::integrators

#pragma once

#include "integrators/exponential/contact_dofs.hpp"
#include "integrators/exponential/modal_loads.hpp"
#include "integrators/local_error.hpp"

namespace butee::integrators {

/// The forces of contacts at the nodes of a step, and the motion of the damped modes under the polynomials through
/// them.
///
/// Sweeps find both: forces at the nodes, motion at the nodes, forces again. Contacts keep the phases that Obstacles
/// follows; stops are open or closed as the motion has them.
class NodeForces {
 public:
  /// Throws InputError for laws that are not piecewise linear. Both must outlive it.
  NodeForces(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes);

  const ContactDofs& dofs() const { return dofs_; }
  /// How far the motion of the contacts between the nodes may be from the polynomial through them, over the largest
  /// scale of their displacements, without forces of contacts.
  double unresolved(const time::State& from, const double* z, const ModalLoads& loads, double h) const;

  enum class Outcome { converged, diverged, not_finite };
  /// Finds the motion of a step from `from` of which free_nodes() is the motion without contacts. Sweeps end where they
  /// change velocities by less than `settled`, relative to their scales.
  Outcome find(const time::State& from, const StepResponse& response, double settled);

  /// Ends the step that was found after `part` of its length, with the same forces; free_nodes() is the motion of the
  /// new step without them. Within the step the polynomials have no superconvergence: the error is their own.
  void end_at(double part, const StepResponse& response);

  Eigen::MatrixXd& free_nodes() { return free_; }
  const Eigen::MatrixXd& nodes() const { return nodes_; }            ///< z at the nodes, 2p x 7
  const Eigen::MatrixXd& polynomial() const { return polynomial_; }  ///< factors of 1, s, ..., s^6, 2p x 7
  /// The z at the end without the values in the middle of the step, less z at the end, and the impulse by which
  /// Lobatto's rule misses that of the forces.
  const Eigen::VectorXd& error() const { return error_; }
  /// The part of the step after which a stop opens or closes; `last`, which may be a little more than 1, where none
  /// does.
  double first_contact_change(double last) const;

 private:
  using AtNodes = Eigen::Matrix<double, Eigen::Dynamic, StepNodes::kCount>;

  void start(const time::State& from);
  /// At one node, and at all but the start.
  void find_forces(double t, double h, Index node);
  void find_forces(double t, double h);
  void move(const StepResponse& response, const StepNodes::Matrix& coefficients);
  void estimate(double t, const StepResponse& response);
  /// The largest change of a velocity by the last sweep, relative to its scale; of a displacement, if that is larger.
  double change(const time::State& from, double h) const;

  /// A motion in which the active DOFs alone move, and its forces.
  struct Instant {
    Vector x, v, force;
  };

  dynamics::Dynamics& dynamics_;
  const dynamics::DampedModes& modes_;
  ContactDofs dofs_;
  ActiveDofs active_;
  Instant instant_;
  Eigen::MatrixXd free_, nodes_, polynomial_, coefficients_;
  Eigen::MatrixXd missed_;  ///< polynomial_ without the values in the middle, less polynomial_
  AtNodes forces_, forces_before_, moved_, moved_velocity_;  ///< of the active DOFs
  Eigen::VectorXd error_;
};

}  // namespace butee::integrators

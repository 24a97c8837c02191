#pragma once

#include "integrators/local_error.hpp"
#include "integrators/modal_response.hpp"

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

  /// The highest frequency of a mass at a contact on its closed stiffness, rad/s; 0 without contacts.
  double highest_frequency() const { return highest_frequency_; }
  /// How far the motion of the contacts between the nodes may be from the polynomial through them, over the largest
  /// scale of their displacements, without forces of contacts.
  double unresolved(const time::State& from, const double* z, double h) const;

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
  /// The z at the end without the values in the middle of the step, less z at the end.
  const Eigen::VectorXd& error() const { return error_; }
  /// The part of the step after which a stop opens or closes; 1 where none does.
  double first_kink() const;

 private:
  using AtNodes = Eigen::Matrix<double, Eigen::Dynamic, StepNodes::kCount>;

  void take_contact(Index dof, double stiffness);
  void find_active();
  void start(const time::State& from);
  void find_forces(double t, double h, Index node);
  void find_forces(double t, double h);
  void move(const StepResponse& response, const StepNodes::Matrix& coefficients);
  void estimate(double t, const StepResponse& response);
  /// The largest change of a velocity by the last sweep, relative to its scale; of a displacement, if that is larger.
  double change(const time::State& from, double h) const;

  dynamics::Dynamics& dynamics_;
  const dynamics::DampedModes& modes_;
  std::vector<Index> dofs_;  ///< of all contacts
  Eigen::ArrayXd reach_;     ///< of each mode: its largest displacement at a contact for |z| = 1
  Vector mobility_;          ///< (M^-1)_dd of each DOF, 1/kg
  double highest_frequency_ = 0.0;
  bool needs_velocity_ = false;

  std::vector<Index> active_;                        ///< DOFs of the contacts that may act in the step
  Eigen::MatrixXd input_, displacement_, velocity_;  ///< the modes' columns of these, 2p x their number
  Eigen::MatrixXd free_, nodes_, polynomial_, coefficients_;
  Eigen::MatrixXd missed_;  ///< polynomial_ without the values in the middle, less polynomial_
  AtNodes forces_, forces_before_, moved_, moved_velocity_;  ///< of the active DOFs
  Vector x_, v_, force_, error_;
};

}  // namespace butee::integrators

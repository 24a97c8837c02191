#pragma once

#include <vector>

#include "butee/dynamics/damped_modes.hpp"
#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

/// The DOFs that contacts act on, as collocation needs them.
class ContactDofs {
 public:
  /// Throws InputError for laws that are not piecewise linear.
  ContactDofs(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes);

  const std::vector<Index>& all() const { return dofs_; }  ///< ascending
  /// The largest displacement of each mode at a contact for |z| = 1.
  const Eigen::ArrayXd& reach() const { return reach_; }
  /// (M^-1)_dd of a contact's DOF, 1/kg
  double inverse_mass(Index dof) const { return inverse_mass_[dof]; }
  /// The highest frequency of a mass at a contact on its closed stiffness, rad/s; 0 without contacts.
  double highest_frequency() const { return highest_frequency_; }
  /// Some contact dissipates or rubs.
  bool need_velocity() const { return need_velocity_; }

 private:
  void take(Index dof, double stiffness, const dynamics::DampedModes& modes);

  std::vector<Index> dofs_;
  Eigen::ArrayXd reach_;
  Vector inverse_mass_;
  double highest_frequency_ = 0.0;
  bool need_velocity_ = false;
};

/// The DOFs of contacts that may act in a step, and their columns of the modes, 2p x their number.
struct ActiveDofs {
  std::vector<Index> dofs;  ///< ascending
  Eigen::MatrixXd input, displacement, velocity;

  /// Finds them by the phases of the contacts; true if they are others than before.
  bool find(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes);
  Index count() const { return static_cast<Index>(dofs.size()); }
  /// The place of one of them.
  Index place(Index dof) const;
};

}  // namespace butee::integrators

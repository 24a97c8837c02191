#pragma once

#include <limits>
#include <vector>

#include "butee/dynamics/damped_modes.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "integrators/exponential/modal_superposition.hpp"

namespace butee::integrators {

/// The DOFs on which contacts act, with the properties that collocation needs.
class ContactDofs {
 public:
  /// Throws InputError for contacts in the plane whose law acts while they are apart. `others` are DOFs of other forces
  /// at the nodes of a step.
  ContactDofs(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes, const std::vector<Index>& others);

  const std::vector<Index>& all() const { return dofs_; }  ///< ascending
  /// The largest displacement of each mode at a contact for |z| = 1.
  const Eigen::ArrayXd& reach() const { return reach_; }
  /// (M^-1)_dd of a DOF with contact or another such force, 1/kg
  double inverse_mass(Index dof) const { return inverse_mass_[dof]; }
  /// The sum of the closed stiffnesses of the contacts on a DOF, N/m
  double stiffness(Index dof) const { return stiffness_[dof]; }
  /// The highest frequency of a mass at a contact on its closed stiffness, rad/s; 0 without contacts.
  double highest_frequency() const { return highest_frequency_; }
  /// True if a contact has dissipation or friction.
  bool need_velocity() const { return need_velocity_; }
  /// True if a contact exerts a force while open.
  bool acts_apart() const { return acts_apart_; }
  /// While all displacements of contacts are smaller than this, m, no contact acts; 0 if there is no such bound.
  double clearance() const { return clearance_; }

 private:
  void take(Index dof, double stiffness, const dynamics::DampedModes& modes);
  /// Takes the law into account, and lowers the clearance to that of a contact with this distance at rest, m, where the
  /// displacement of the contact is `most` times the largest one of a DOF at most.
  void limit_clearance(const model::ContactLaw* law, double distance, double most);
  void find_inverse_mass(Index dof, const dynamics::DampedModes& modes);

  std::vector<Index> dofs_;
  Eigen::ArrayXd reach_;
  Vector inverse_mass_, stiffness_;
  double highest_frequency_ = 0.0;
  double clearance_ = std::numeric_limits<double>::infinity();
  bool need_velocity_ = false, acts_apart_ = false;
};

/// The DOFs of contacts that may act in a step and of other forces at its nodes, and their motion from the modes.
struct ActiveDofs {
  std::vector<Index> dofs;  ///< ascending
  ModalSuperposition superposition;

  /// `modes` must outlive it.
  explicit ActiveDofs(const dynamics::DampedModes& modes) : superposition(modes) {}

  /// Finds them from the phases of the contacts; true if they have changed.
  bool find(dynamics::Dynamics& dynamics, const std::vector<Index>& others);
  Index count() const { return static_cast<Index>(dofs.size()); }
  /// The index of a DOF in `dofs`.
  Index place(Index dof) const;
};

}  // namespace butee::integrators

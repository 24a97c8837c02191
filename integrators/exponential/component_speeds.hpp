#pragma once

#include "butee/dynamics/modal_system.hpp"
#include "integrators/error_account.hpp"

namespace butee::integrators {

/// The largest velocity of each DOF so far, at the starts of macro steps and of steps for which MissedForces finds it.
/// It is a part of the state.
class ComponentSpeeds {
 public:
  /// `modal` must outlive it.
  ComponentSpeeds(const model::System& system, const dynamics::ModalSystem& modal);

  Index memory_size() const { return largest_.size(); }
  /// Fills the entries of a state with the modal displacements `q`: velocities below `rounding_rate`, 1/s, times the
  /// displacements are rounding.
  void start(const double* q, double rounding_rate, double* memory) const;
  void load(const double* memory);
  void save(double* memory) const;

  /// Raises them to the velocities of a state with the modal speeds `v`.
  void raise(const Eigen::ArrayXd& v);
  /// Raises them to `speeds`, m/s or rad/s.
  void raise_to(const Vector& speeds) { largest_ = largest_.cwiseMax(speeds); }
  /// In m/s or rad/s.
  const Vector& largest() const { return largest_; }
  /// The largest velocity of a component by the given speeds of the modes, in independent phases, relative to its
  /// largest velocity so far, or to kLeastOfKind of the largest of its kind; 0 before anything moves.
  double relative(const Eigen::ArrayXd& modal_speeds);

 private:
  const dynamics::ModalSystem& modal_;
  ComponentScales scales_;
  Vector largest_, now_, of_kind_;
};

}  // namespace butee::integrators

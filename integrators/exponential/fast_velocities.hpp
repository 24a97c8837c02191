#pragma once

#include "butee/dynamics/modal_system.hpp"

namespace butee::integrators {

/// Bounds how far velocities depart from those of the quintic between two breakpoints. Steps are as long as the
/// displacements at the stops allow; modes that a pulse or an impact has set in motion may turn many times in them, and
/// while their displacements are below the tolerance, their velocities are not.
class FastVelocities {
 public:
  /// `modal` must outlive it.
  explicit FastVelocities(const dynamics::ModalSystem& modal);

  /// The bound for a DOF, m/s or rad/s, in a part of length h, s, of a step with the modal speeds v0 and v1 at its
  /// ends.
  double departure(Index dof, double h, const double* v0, const double* v1) const;

 private:
  const dynamics::ModalSystem& modal_;
  Eigen::ArrayXd rates_;  ///< 1/s
};

}  // namespace butee::integrators

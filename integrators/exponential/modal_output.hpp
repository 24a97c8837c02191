#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/exponential/motion_in_step.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// Displacements, velocities and accelerations of individual DOFs at the breakpoints of a macro
/// step and between them.
class ModalOutput {
 public:
  /// All must outlive it.
  ModalOutput(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, Breakpoints& breakpoints,
              MotionInStep& motion);

  /// Discards cached values at a breakpoint that has been replaced.
  void forget(std::size_t breakpoint);
  /// Interpolates the motion of `dofs` at `times`, which ascend.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);

 private:
  /// The coefficients of modes, loads and stop forces in the displacement and acceleration of a
  /// DOF.
  struct View {
    Index dof;
    Vector shape, of_q;  ///< padded for dynamics::ModalMotion
    Vector of_v, of_harmonics, of_loads, of_stops;
    std::vector<Motion> motions;  ///< cached motions at the breakpoints
    std::vector<bool> is_known;
  };

  std::size_t view_of(Index dof);
  const Motion& motion_at(std::size_t breakpoint, View& view);
  /// The motion from `products` (x, v and of_q . q of the DOF), modal speeds v, cos and sin of the
  /// loads and, unless null, the forces of the stops.
  Motion motion_of(const View& view, double t, const std::array<double, 3>& products, const double* v,
                   std::span<const Phase> phases, const Vector* stop_forces) const;

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  Breakpoints& breakpoints_;
  MotionInStep& motion_;
  double single_decay_;  ///< decay rate if it is the same for all modes, 1/s; negative if they differ
  std::vector<View> views_;
  std::vector<std::size_t> asked_;
  Eigen::MatrixXd stop_forces_;  ///< at the breakpoints, N
  std::vector<bool> has_forces_;
  Vector forces_at_;
};

}  // namespace butee::integrators

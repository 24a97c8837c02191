#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/exponential/motion_in_step.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// Displacements, velocities and accelerations of single DOFs at the breakpoints of a macro step and between them.
class ModalOutput {
 public:
  /// All must outlive it.
  ModalOutput(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, Breakpoints& breakpoints,
              MotionInStep& motion);

  /// Forgets what was known at a breakpoint that now is another.
  void forget(std::size_t breakpoint);
  /// The motion of `dofs` at `times`, ascending.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);

 private:
  /// The shares of modes, loads and stop forces in the displacement and acceleration of a DOF.
  struct View {
    Index dof;
    Vector shape, of_q;  ///< padded for dynamics::ModalMotion
    Vector of_v, of_harmonics, of_loads, of_stops;
    std::vector<Motion> motions;  ///< at the breakpoints
    std::vector<bool> is_known;
  };

  std::size_t view_of(Index dof);
  const Motion& motion_at(std::size_t breakpoint, View& view);
  /// From x, v and of_q . q of the DOF, modal speeds, cos and sin of the loads and, if there are any, the forces of the
  /// stops.
  Motion motion_of(const View& view, double t, const std::array<double, 3>& products, const double* v,
                   std::span<const Phase> phases, const Vector* stop_forces) const;

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  Breakpoints& breakpoints_;
  MotionInStep& motion_;
  double single_decay_;  ///< of all modes alike, 1/s; negative if they differ
  std::vector<View> views_;
  std::vector<std::size_t> asked_;
  Eigen::MatrixXd stop_forces_;  ///< at the breakpoints, N
  std::vector<bool> has_forces_;
  Vector forces_at_;
};

}  // namespace butee::integrators

#pragma once

#include "integrators/exponential/derivative_bounds.hpp"
#include "integrators/exponential/fast_velocities.hpp"
#include "integrators/exponential/hidden_modes.hpp"
#include "integrators/exponential/modal_energy.hpp"
#include "integrators/exponential/modal_output.hpp"
#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The record of a macro step for outputs: its breakpoints, the motion between them, energies and
/// derivative bounds.
class MacroStep {
 public:
  /// For up to `most` steps; `tolerance` is the error bound of outputs, relative to the displacement scale. The
  /// references must outlive it.
  MacroStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts,
            std::size_t most, double tolerance);

  void begin(double t, const ModalState& state);
  /// Adds a breakpoint; the forces of the step that ends there must be filled before.
  void add(double t, const ModalState& state);

  Breakpoints& breakpoints() { return breakpoints_; }
  const Breakpoints& breakpoints() const { return breakpoints_; }

  /// The instants within the macro step between which the motion is that of a quintic.
  std::span<const double> inner();
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
    output_.interpolate(times, dofs, out);
  }
  /// time::Interpolant::energies()
  std::span<const time::EnergyAt> energies(std::span<const double> instants);
  /// time::Interpolant::departure(); with stops only that of velocities.
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out);

 private:
  HiddenModes::State state(std::size_t k) const { return {breakpoints_.time(k), breakpoints_.q(k), breakpoints_.v(k)}; }

  const dynamics::ModalSystem& modal_;
  Breakpoints breakpoints_;
  MotionInStep motion_;
  ModalOutput output_;
  ModalEnergy energy_;
  DerivativeBounds bounds_;
  HiddenModes hidden_;
  FastVelocities fast_;
  std::vector<double> inner_;
  Eigen::ArrayXd w_middle_;
};

}  // namespace butee::integrators

#pragma once

#include "integrators/exponential/derivative_bounds.hpp"
#include "integrators/exponential/modal_energy.hpp"
#include "integrators/exponential/modal_output.hpp"
#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The record of a macro step for outputs: its breakpoints, the motion between them, energies and
/// derivative bounds.
class MacroStep {
 public:
  /// For up to `most` steps. The references must outlive it.
  MacroStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts,
            std::size_t most);

  void begin(double t, const ModalState& state);
  /// Adds a breakpoint; the forces of the step that ends there must be filled before.
  void add(double t, const ModalState& state);

  Breakpoints& breakpoints() { return breakpoints_; }
  const Breakpoints& breakpoints() const { return breakpoints_; }

  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
    output_.interpolate(times, dofs, out);
  }
  /// time::Interpolant::energies()
  std::span<const time::EnergyAt> energies(std::span<const double> instants);
  /// Without stops: time::Interpolant::departure()
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
    bounds_.departure(begin, end, dofs, out);
  }

 private:
  const dynamics::ModalSystem& modal_;
  Breakpoints breakpoints_;
  MotionInStep motion_;
  ModalOutput output_;
  ModalEnergy energy_;
  DerivativeBounds bounds_;
  Eigen::ArrayXd w_middle_;
};

}  // namespace butee::integrators

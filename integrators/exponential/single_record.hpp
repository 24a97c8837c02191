#pragma once

#include <array>
#include <span>
#include <vector>

#include "integrators/exponential/error_indicators.hpp"
#include "integrators/exponential/modal_energy.hpp"
#include "integrators/exponential/single_flow.hpp"
#include "integrators/exponential/single_motion.hpp"

namespace butee::integrators {

/// The record of a macro step of one DOF with one stop for outputs: breakpoints, the motion at them
/// and between them, and energies.
class SingleRecord {
 public:
  /// The references must outlive it. `tolerance` is that of outputs, relative to the scales; `most`
  /// is the largest number of steps.
  SingleRecord(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, const SingleMode& mode,
               ContactForce& contact, double tolerance, std::size_t most);

  void begin(double t, Oscillator::Point at, const double* phase_memory);
  void add(const SingleFlow& flow, const SingleBreakpoint::Step& step, double t, Oscillator::Point at);

  double last() const { return breakpoints_.back().t; }
  std::span<const double> inner() const;
  const LoadPhases& phases() const { return phases_; }
  std::span<const Phase> last_phases() const { return phases_.at(breakpoints_.size() - 1); }
  void save_phases(double* memory) const { phases_.save(breakpoints_.size() - 1, memory); }

  /// `scale`: the largest displacement and speed so far.
  void interpolate(std::span<const double> times, ContactScale scale, time::Interpolated out);
  /// time::Interpolant::energies()
  std::span<const time::EnergyAt> energies(std::span<const double> instants);

 private:
  const Motion& motion_at(std::size_t k);
  Motion motion_within(std::size_t k, double t) {
    return motion_.within(breakpoints_[k], breakpoints_[k + 1], phases_.at(k), t);
  }
  /// True if the quintic is accurate enough in the step that begins at breakpoint k.
  bool is_quintic(std::size_t k, double speed) const;

  const SingleMode& mode_;
  ContactForce& contact_;
  double tolerance_;
  std::vector<SingleBreakpoint> breakpoints_;
  std::vector<double> times_;  ///< times of the breakpoints, s
  LoadPhases phases_;
  SingleMotion motion_;
  ModalEnergy energy_;
};

}  // namespace butee::integrators

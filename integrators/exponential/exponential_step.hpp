#pragma once

#include <optional>
#include <vector>

#include "integrators/exponential/contact_error.hpp"
#include "integrators/exponential/interpolation_check.hpp"
#include "integrators/exponential/macro_step.hpp"
#include "integrators/exponential/step_size.hpp"

namespace butee::integrators {

/// Performs the steps of the method `exponential` within a macro step: propagates the modes, finds
/// the stops that may close, iterates for their forces and evaluates the error. Other classes
/// implement these parts; this class defines their order. Checked in
/// tests/unit/exponential_step_test.cpp and tests/models/exponential_test.cpp.
class ExponentialStep {
 public:
  /// Macro steps have up to `most` steps. `dynamics` and `modal` must outlive it.
  ExponentialStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, const StepGoal& goal, std::size_t most);

  /// A state holds q, v, displacements and speeds of the stops, ContactScales and
  /// ContactError. complete() fills the entries behind q and v at the start of a run.
  Index memory_size() const {
    return 2 * modal_.size() + 2 * modal_.stop_count() + scales_.memory_size() + contact_error_.memory_size();
  }
  void complete(double t, double* memory) const;
  /// True if a stop is exactly in the middle of its gap, where its force jumps.
  bool rests_in_middle() const;
  /// Fills the displacements and speeds of the stops from those of the modes.
  void find_stops(double* memory) const;
  /// Begins a macro step from the state at t.
  void begin(double t, const double* memory, ContactScale scale);
  void save(double* memory) const;

  /// Attempts a step with an index of the step size grid, or up to t. accept() accepts it, with t
  /// as its end.
  Trial attempt_index(int index) {
    return attempt(modal_.propagator(index), t() + dynamics::ModalSystem::grid_step(index));
  }
  Trial attempt_until(double t);
  StepSizeControl::Outcome outcome() const {
    return {!step_.is_near, {error_, goal_.middle * scales_.largest().displacement}, interpolation_.error()};
  }
  void accept(double t);
  /// Raises the scales to the motion of the stops without contact in a step with this grid index.
  void expect_motion(int index);

  double t() const { return record_.breakpoints().last(); }
  const double* q() const { return step_.from.q.data(); }
  const double* v() const { return step_.from.v.data(); }
  ContactScale scale() const { return scales_.largest(); }
  /// ContactGaps::time_to_contact()
  double time_to_contact() const { return bounds_.gaps().time_to_contact(step_.from); }
  bool has_stops() const { return !contacts_.empty(); }

  std::span<const double> breakpoints() { return record_.inner(); }
  /// Interpolates within the macro step; does not change the state.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
    record_.interpolate(times, dofs, out);
  }
  /// time::Interpolant::energies() of the macro step; empty without stops, since steps then have any
  /// length.
  std::span<const time::EnergyAt> energies(std::span<const double> instants) {
    return has_stops() ? record_.energies(instants) : std::span<const time::EnergyAt>();
  }
  /// time::Interpolant::departure(); with stops only that of velocities.
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
    record_.departure(begin, end, dofs, out);
  }

 private:
  Trial attempt(dynamics::ContactPropagator& flow, double t_end);
  /// Attempts the step with the stops of step_.carried among the iterated ones; empty if
  /// step_.carried has grown, so that the attempt must be repeated.
  std::optional<Trial> attempt(dynamics::ContactPropagator& flow);
  /// Adds the residual forces of stops that cross w = 0; false if the step is too long for them.
  bool add_jumps(dynamics::ContactPropagator& flow);
  /// Propagates to t_end without contact; `v` may be null.
  void propagate(const dynamics::ModalPropagator& flow, double t_end, Eigen::ArrayXd& q, Eigen::ArrayXd* v);
  /// Propagates to the end of the step; false if the result is not finite.
  bool propagate_to_end(const dynamics::ModalPropagator& flow);
  const Eigen::ArrayXd* residual_force() const { return errors_.any() ? &residual_.modal() : nullptr; }
  /// Separates the stops whose forces are found by iteration from all others.
  void choose_stops(dynamics::ContactPropagator& flow);
  /// Adds stops that the residual forces bring near their gaps to the iterated ones; false if there
  /// are none.
  bool choose_more_stops(dynamics::ContactPropagator& flow);
  /// Outputs on a quintic through the ends are accurate enough, if necessary with a breakpoint in
  /// the middle.
  bool is_smooth(dynamics::ContactPropagator& flow);
  bool shows_jump() const;
  /// Records the forces of the step that begins at the last breakpoint.
  void record_forces();
  void record_contacts(StepForces& forces, bool has_contact) const;

  dynamics::ModalSystem& modal_;
  StepGoal goal_;
  std::vector<ContactForce> contacts_;
  MacroStep record_;
  TriedStep step_;
  DisplacementBounds bounds_;
  ContactScales scales_;
  ResidualErrors errors_;
  ResidualForces residual_;
  ResidualJumps jumps_;
  ContactIteration iteration_;
  ContactError contact_error_;
  InterpolationCheck interpolation_;
  double error_ = 0.0;  ///< from contact_error_, m
};

}  // namespace butee::integrators

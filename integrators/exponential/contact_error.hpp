#pragma once

#include <utility>
#include <vector>

#include "integrators/exponential/change_accounts.hpp"
#include "integrators/exponential/contact_iteration.hpp"
#include "integrators/exponential/missed_forces.hpp"
#include "integrators/exponential/residual_forces.hpp"
#include "integrators/exponential/unresolved_modes.hpp"

namespace butee::integrators {

/// The error of a step with contact: the largest of the indicators 1 to 10 of
/// plugins/exponential/THEORY.md, section 8.1, over all stops. Errors of changes of contact are
/// charged to the accounts of their stops, those of modes that do not feel closed stops to another one.
class ContactError {
 public:
  /// All must outlive it.
  ContactError(const model::System& system, const dynamics::ModalSystem& modal, const StepGoal& goal,
               std::vector<ContactForce>& contacts, const DisplacementBounds& bounds, const ContactScales& scales,
               const ContactIteration& iteration, const ResidualErrors& residual);

  Index memory_size() const { return accounts_.memory_size() + speeds_.memory_size() + modes_.memory_size(); }
  /// Fills the entries of a state with the modal displacements `q` and those of the stops, `w`, at the start of a run.
  void start(double t, const double* q, const double* w, double* memory) const;
  /// Begins a macro step with the state at t.
  void load(double t, const double* memory, const ModalState& state);
  void save(double* memory) const;

  /// Begins an attempt at a step.
  void begin() { changes_.clear(); }
  /// Charges the errors of an accepted step to the accounts.
  void charge(const TriedStep& step);

  /// The error of the step with its forces, m; `displacement` is the largest displacement of all
  /// stops, m.
  double of_step(dynamics::ContactPropagator& flow, const TriedStep& step, double displacement);
  /// The error of the end of the step, which includes its forces, by modes that closed stops move (indicator 8),
  /// relative to its bound.
  double of_modes(const TriedStep& step);
  /// Indicator 6, relative to the error bound of velocities: the residual force of a stop, whose speed scale is
  /// `speed`, jumps in the step.
  double of_jump(const dynamics::ContactPropagator& flow, Index stop, double speed);

 private:
  /// `quartic`: the size of the path's quartic coefficient beyond rounding, m.
  double of_touched(dynamics::ContactPropagator& flow, Index stop, double t_end, double quartic, double displacement);
  /// Indicator 10, relative to its bound.
  double of_missed(dynamics::ContactPropagator& flow, const TriedStep& step, double displacement);
  /// The error of the speed of a stop by that of its path, by the models of indicators 2 and 7, m/s, in the sense of
  /// its quartic; 0 if it stays closed.
  double speed_error(dynamics::ContactPropagator& flow, Index stop) const;

  const dynamics::ModalSystem& modal_;
  const StepGoal& goal_;
  const DisplacementBounds& bounds_;
  const ContactScales& scales_;
  const ContactIteration& iteration_;
  const ResidualErrors& residual_;
  ChangeAccounts accounts_;
  ComponentSpeeds speeds_;
  UnresolvedModes modes_;
  MissedForces missed_;
  Eigen::ArrayXd rounding_;  ///< of the quartic coefficients of paths, m
  Eigen::ArrayXd hidden_;    ///< speeds of the modes that a jump would cause and the projection hides
  std::vector<std::pair<Index, double>>
      changes_;  ///< stops that change or stay closed in the step, and their speed errors
};

}  // namespace butee::integrators

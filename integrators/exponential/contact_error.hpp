#pragma once

#include <utility>
#include <vector>

#include "integrators/exponential/change_accounts.hpp"
#include "integrators/exponential/contact_iteration.hpp"
#include "integrators/exponential/residual_forces.hpp"

namespace butee::integrators {

/// The error of a step with contact: the largest of the indicators 1 to 7 of
/// plugins/exponential/THEORY.md, section 8.1, over all stops. Errors of changes of contact are
/// charged to the accounts of their stops.
class ContactError {
 public:
  /// All must outlive it.
  ContactError(const StepGoal& goal, const std::vector<ContactForce>& contacts, const DisplacementBounds& bounds,
               const ContactScales& scales, const ContactIteration& iteration, const ResidualErrors& residual,
               double lowest_frequency)
      : goal_(goal),
        contacts_(contacts),
        bounds_(bounds),
        scales_(scales),
        iteration_(iteration),
        residual_(residual),
        accounts_(goal, lowest_frequency, static_cast<Index>(contacts.size())) {}

  ChangeAccounts& accounts() { return accounts_; }
  const ChangeAccounts& accounts() const { return accounts_; }
  /// Begins an attempt at a step.
  void begin() { changes_.clear(); }
  /// Charges the changes of contact of the step that of_step() judged last.
  void charge() {
    for (const auto& [stop, error] : changes_) accounts_.charge(stop, error);
  }

  /// The error of the step with its forces, m; `displacement` is the largest displacement of all
  /// stops, m.
  double of_step(dynamics::ContactPropagator& flow, const TriedStep& step, double displacement);
  /// Indicator 6, relative to the error bound of the speed: the residual force of a stop jumps in
  /// the step.
  double of_jump(const dynamics::ContactPropagator& flow, Index stop, double speed) const {
    const double hidden = 2.0 * residual_.force(stop).largest() * iteration_.influence().hidden_by_jump(flow, stop);
    return hidden / (kUnresolved * goal_.outputs * flow.h() * speed);
  }

 private:
  /// Bound of the speed error due to the projection of the force, as a multiple of the error bound
  /// of outputs.
  static constexpr double kUnresolved = 1.0;

  double of_touched(dynamics::ContactPropagator& flow, Index stop, double t_end, double quartic, double displacement);

  const StepGoal& goal_;
  const std::vector<ContactForce>& contacts_;
  const DisplacementBounds& bounds_;
  const ContactScales& scales_;
  const ContactIteration& iteration_;
  const ResidualErrors& residual_;
  ChangeAccounts accounts_;
  std::vector<std::pair<Index, double>> changes_;  ///< stops that close or open in the step, and their speed errors
};

}  // namespace butee::integrators

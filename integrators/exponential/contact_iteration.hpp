#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrators/exponential/contact_influence.hpp"
#include "integrators/exponential/contact_paths.hpp"
#include "integrators/exponential/contact_scales.hpp"

namespace butee::integrators {

/// Finds the forces and paths of the stops near their gaps over a step: Gauss-Seidel sweeps over
/// the stops, with Newton's method for each (plugins/exponential/THEORY.md, section 6). Checked in
/// tests/unit/contact_iteration_test.cpp.
class ContactIteration {
 public:
  /// All must outlive it.
  ContactIteration(const dynamics::ModalSystem& modal, const StepGoal& goal, std::vector<ContactForce>& contacts,
                   const ContactGaps& gaps, const ContactScales& scales, const TriedStep& step);

  /// Finds the forces of the stops in step.iterated. Returns the largest displacement of a stop, m;
  /// empty if the iteration does not converge.
  std::optional<double> solve(dynamics::ContactPropagator& flow);
  /// Adds the effect of the forces to the paths of all other stops.
  void complete_paths(dynamics::ContactPropagator& flow);
  /// After complete_paths(): adds the forces to the end of the step, and to its middle if there is
  /// a breakpoint.
  void apply(dynamics::ContactPropagator& flow, TriedStep& step);

  const ContactPaths& paths() const { return paths_; }
  const ContactInfluence& influence() const { return influence_; }
  /// The stiffness of a stop along its path, N/m.
  double stiffness(Index stop) const {
    const ContactForce& contact = contacts_[static_cast<std::size_t>(stop)];
    return contact.is_bounded() ? contact.stiffness() : contact.stiffness_along(paths_.of(stop));
  }
  /// sigma = (h omega_c)^2, with omega_c the frequency of the closed stop alone.
  double stiff(dynamics::ContactPropagator& flow, Index stop) const {
    return stiffness(stop) * influence_.of(flow, stop).coupling[1][0];
  }
  /// The stops that exert a force in the step.
  const std::vector<Index>& touched() const { return touched_; }
  bool is_touched(Index stop) const { return is_touched_[static_cast<std::size_t>(stop)] != 0; }
  /// Moment k of the forces: for each stop, N, and summed as modal forces.
  const Eigen::ArrayXd& moments(std::size_t k) const { return moments_[k]; }
  const Eigen::ArrayXd& modal_moments(std::size_t k) const { return sums_[k]; }

 private:
  void begin();
  /// Fills near_registers_ and far_registers_.
  void choose_registers();
  /// Initial guess: the forces of the stops that are closed at the start, for constant speed, and those of stops that
  /// have just left the middle of their gap, since the motion without them may lead to the other side.
  void guess(dynamics::ContactPropagator& flow);
  /// One sweep; returns the largest change of a path over allowed_change(). `may_skip`: the force of a stop is kept if
  /// other stops moved its path so little that the force would not move it by unfinished_.
  double sweep(dynamics::ContactPropagator& flow, double displacement, bool may_skip);
  /// Updates allowed_ of a stop and returns it, m.
  double allow(dynamics::ContactPropagator& flow, Index stop, double displacement);
  bool is_spring(Index stop) const;
  /// Stores the path of a stop for which its force was computed, and whether it is a spring there.
  void note_path(Index stop, bool is_spring);
  /// True if the path of a stop has changed so little since its force was found that the missing force would not move
  /// it by unfinished_, and is below the tolerance. Beside the bends of its law the residual force may change faster
  /// than the spring force.
  bool keeps_force(dynamics::ContactPropagator& flow, Index stop) const;
  void touch(Index stop);
  /// Adds `more` to the force of a stop; returns the largest change of a path, m.
  double add_force(dynamics::ContactPropagator& flow, Index stop, const ForceMoments& more);

  const dynamics::ModalSystem& modal_;
  const StepGoal& goal_;
  std::vector<ContactForce>& contacts_;
  const ContactGaps& gaps_;
  const ContactScales& scales_;
  const TriedStep& step_;
  ContactInfluence influence_;
  ContactPaths paths_;          ///< those outside near_registers_ lack the forces until complete_paths()
  dynamics::StopMotion noted_;  ///< the paths stored by note_path()
  std::vector<Index> near_registers_, far_registers_;  ///< vector registers with iterated stops, and all others
  std::array<Eigen::ArrayXd, 3> moments_, sums_;
  Eigen::ArrayXd allowed_;  ///< allowed_change() of the stops whose forces have been computed, m
  std::vector<Index> touched_;
  std::vector<char> is_touched_, is_spring_noted_;
  double unfinished_ = 1.0;  ///< unfinished_change()
};

}  // namespace butee::integrators

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrators/exponential/contact_influence.hpp"
#include "integrators/exponential/contact_paths.hpp"
#include "integrators/exponential/contact_scales.hpp"

namespace butee::integrators {

/// The forces of the stops near their gaps and their paths over a step, found together: sweeps over the stops in turn
/// (Gauss-Seidel), with Newton's method for each (plugins/exponential/THEORY.md, section 6). Checked in
/// tests/unit/contact_iteration_test.cpp.
class ContactIteration {
 public:
  /// All must outlive it.
  ContactIteration(const dynamics::ModalSystem& modal, const StepGoal& goal, std::vector<ContactForce>& contacts,
                   const ContactGaps& gaps, const ContactScales& scales, const TriedStep& step);

  /// Finds the forces of step.iterated; the largest displacement of a stop, or nothing if it does not converge.
  std::optional<double> solve(dynamics::ContactPropagator& flow);
  /// Completes the paths of all other stops with the forces.
  void complete_paths(dynamics::ContactPropagator& flow);
  /// Adds the forces, after complete_paths(), to the end of the step, and to its middle if outputs are to know of it.
  void apply(dynamics::ContactPropagator& flow, TriedStep& step);

  const ContactPaths& paths() const { return paths_; }
  const ContactInfluence& influence() const { return influence_; }
  /// The stops with a force.
  const std::vector<Index>& touched() const { return touched_; }
  bool is_touched(Index stop) const { return is_touched_[static_cast<std::size_t>(stop)]; }
  /// Moment k of the force of each stop, N, and of all of them as modal forces.
  const Eigen::ArrayXd& moments(std::size_t k) const { return moments_[k]; }
  const Eigen::ArrayXd& modal_moments(std::size_t k) const { return sums_[k]; }

 private:
  /// After the first sweep a stop keeps its force if others moved its path by less than this fraction of
  /// allowed_change().
  static constexpr double kSettled = 0.2;

  void begin();
  /// Fills near_registers_ and far_registers_.
  void choose_registers();
  /// Starts with the forces of the stops that are closed at the start, at constant speed.
  void guess(dynamics::ContactPropagator& flow);
  /// The largest change of a path over allowed_change(). `may_skip`: as by kSettled.
  double sweep(dynamics::ContactPropagator& flow, double displacement, bool may_skip);
  double allowed_change(dynamics::ContactPropagator& flow, Index stop, double displacement) const;
  bool is_spring(Index stop) const;
  /// Notes the path of a stop that its force was found for.
  void note_path(Index stop);
  /// By how much the path of a stop differs from that, with what a stiff stop makes of it in h times its speed, m.
  double moved_since(dynamics::ContactPropagator& flow, Index stop) const;
  void touch(Index stop);
  /// Adds to the force of a stop; the largest change of a path.
  double add_force(dynamics::ContactPropagator& flow, Index stop, const ForceMoments& more);

  const dynamics::ModalSystem& modal_;
  const StepGoal& goal_;
  std::vector<ContactForce>& contacts_;
  const ContactGaps& gaps_;
  const ContactScales& scales_;
  const TriedStep& step_;
  ContactInfluence influence_;
  ContactPaths paths_;          ///< outside near_registers_ without forces until complete_paths()
  dynamics::StopMotion noted_;  ///< note_path()
  std::vector<Index> near_registers_, far_registers_;  ///< with iterated stops, and all others
  std::array<Eigen::ArrayXd, 3> moments_, sums_;
  std::vector<Index> touched_;
  std::vector<bool> is_touched_;
};

}  // namespace butee::integrators

#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/contact_gaps.hpp"
#include "integrators/exponential/contact_paths.hpp"
#include "integrators/exponential/contact_scales.hpp"
#include "integrators/exponential/residual_force.hpp"

namespace butee::integrators {

/// The errors if residual forces are taken as constant over a step, and if their jumps are ignored
/// (plugins/exponential/THEORY.md, section 9).
class ResidualErrors {
 public:
  /// All must outlive it.
  ResidualErrors(const dynamics::ElasticStops& contact, const StepGoal& goal, const DisplacementBounds& bounds,
                 const ContactScales& scales, const TriedStep& step);

  /// True if a law has a residual force.
  bool any() const { return any_; }
  /// True if the residual force of a stop jumps in the middle of its gap.
  bool jumps() const {
    return std::any_of(forces_.begin(), forces_.end(),
                       [](const ResidualForce& force) { return force.jumps() && force.largest() > 0.0; });
  }
  const ResidualForce& force(Index stop) const { return forces_[static_cast<std::size_t>(stop)]; }
  /// Computes shares(), the scale of each stop as a fraction of the largest.
  void find_shares();
  const Eigen::ArrayXd& shares() const { return shares_; }
  /// Finds the stops whose force is certainly constant, and raises step.reached to the speed that
  /// the forces cause.
  void find_constant(dynamics::ContactPropagator& flow, TriedStep& step);
  /// True if the force of a stop may be taken as constant.
  bool is_constant(dynamics::ContactPropagator& flow, Index stop) const {
    return is_constant_[stop] || may_be(flow, stop);
  }
  /// The same after the end of the step has changed.
  bool may_be(dynamics::ContactPropagator& flow, Index stop) const;

  /// The bound of these errors over one characteristic time of the motion, m.
  double allowed() const {
    const double steps = this->steps();
    return kResidualError * goal_.outputs * step_.reached.displacement * share_of_run(step_.h, steps, goal_.run_time);
  }
  /// The characteristic time of the motion in steps.
  double steps() const { return characteristic_steps(step_.reached, step_.h); }
  /// The largest displacement of a stop in the step by its residual force, divided by shares(), m.
  double largest_scaled_shift() const { return largest_scaled_shift_; }

  /// Indicator 6: the error of the displacement, m, due to a jump of the force where the path
  /// crosses w = 0.
  double jump_error(dynamics::ContactPropagator& flow, Index stop, double quartic, double end) const;
  /// True if outputs would show the jump of the force of a stop that crosses w = 0 in the step.
  bool shows_jump(Index stop, double compliance) const;

 private:
  const StepGoal& goal_;
  const DisplacementBounds& bounds_;
  const ContactScales& scales_;
  const TriedStep& step_;
  std::vector<ResidualForce> forces_;
  bool any_ = false;
  Eigen::ArrayXd largest_, bends_;  ///< N; width of the law's bend, m
  Eigen::ArrayXd shares_;
  Eigen::Array<bool, Eigen::Dynamic, 1> is_constant_;
  double largest_scaled_shift_ = 0.0;
};

/// The residual forces that the propagator carries as constants from step to step.
class ResidualForces {
 public:
  /// Both must outlive it.
  ResidualForces(const dynamics::ModalSystem& modal, dynamics::ElasticStops& contact);

  /// Sets the forces at the start of a macro step: to those at the displacements `w` of stops that have just left the
  /// middle of their gap, since the motion without these forces may lead to the other side; else to zero.
  void begin(const Eigen::ArrayXd& w);
  /// If the law at the middle of the step differs so much that a stop would move by more than the
  /// bound, replaces the forces by it and updates the end of the step. True if it did.
  bool update(dynamics::ContactPropagator& flow, const ResidualErrors& errors, TriedStep& step);

  const Vector& forces() const { return forces_; }  ///< N; 0 for iterated stops
  const Eigen::ArrayXd& modal() const { return modal_force_; }

 private:
  const dynamics::ModalSystem& modal_;
  dynamics::ElasticStops& contact_;
  Vector forces_, next_forces_;
  std::vector<Index> leaving_;
  Eigen::ArrayXd modal_force_, old_modal_force_, w_middle_;
};

/// The stops that cross w = 0 in a step, where their residual force changes its sign, and the
/// moments of these forces.
class ResidualJumps {
 public:
  /// All must outlive it.
  ResidualJumps(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts);

  /// Finds them among step.constant; true if there are any.
  bool find(dynamics::ContactPropagator& flow, const ResidualErrors& errors, const TriedStep& step);
  /// Adds the moments of their forces minus the `constants`, which the step already contains; the
  /// middle of the step must be known.
  void add(dynamics::ContactPropagator& flow, const Vector& constants, TriedStep& step);

  /// Finds the stops among step.constant whose moments differ by more than the bound on `paths`,
  /// which include the forces of the iterated stops, and adds them to step.crossing. True if there
  /// are any.
  bool find_moved(dynamics::ContactPropagator& flow, const ResidualErrors& errors, const Vector& constants,
                  const ContactPaths& paths, TriedStep& step) const;

  const std::vector<Index>& stops() const { return stops_; }
  const ForceMoments& moments(std::size_t place) const { return moments_[place]; }
  /// The quartic coefficient of the path for which the moments were computed.
  double quartic(std::size_t place) const { return quartics_[place]; }
  const Eigen::ArrayXd& modal_moments(std::size_t k) const { return sums_[k]; }

 private:
  const dynamics::ModalSystem& modal_;
  std::vector<ContactForce>& contacts_;
  std::vector<Index> stops_;
  std::vector<ForceMoments> moments_;
  std::vector<double> quartics_;
  std::array<Eigen::ArrayXd, 3> by_stop_, sums_;
};

}  // namespace butee::integrators

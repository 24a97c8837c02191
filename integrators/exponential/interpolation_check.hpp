#pragma once

#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The error of the quintic through displacements, speeds and accelerations of the stops at the ends of a step without
/// contact, over the error bound of outputs (plugins/exponential/THEORY.md, section 8.2). By a bound that takes all
/// modes for in phase, or by the exact displacements in the middle of the step. Checked in
/// tests/unit/interpolation_check_test.cpp.
class InterpolationCheck {
 public:
  /// `modal` must outlive it; `tolerance` of outputs, relative to the displacement scale.
  InterpolationCheck(const dynamics::ModalSystem& modal, double tolerance);

  /// The bound is small enough. `of_loads`: the part of the Hermite interpolation error that loads cause, m.
  bool is_bounded(const dynamics::ContactPropagator& flow, const TriedStep& step, double of_loads);
  /// The quintic is good enough by the middle of the step, if need be with a breakpoint there, which it sets.
  /// `constant_force`: modal; nullptr: none.
  bool is_close(TriedStep& step, const Eigen::ArrayXd* constant_force);
  /// The error over its bound, by the last of these.
  double error() const { return error_; }

 private:
  /// Accelerations of the stops without contact.
  void find_accelerations(double t, const ModalState& state, const Eigen::ArrayXd* constant_force, Eigen::ArrayXd& a);

  const dynamics::ModalSystem& modal_;
  double tolerance_;
  Eigen::ArrayXd squares_;   ///< omega^2
  bool is_strongly_damped_;  ///< a mode decays so fast that bounds by omega say too little
  Eigen::ArrayXd modal_acceleration_, a_, a_end_;
  double error_ = 0.0;
};

}  // namespace butee::integrators

#pragma once

#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The error of the quintic through displacements, speeds and accelerations of the stops at the
/// ends of a step without contact, divided by the error bound of outputs
/// (plugins/exponential/THEORY.md, section 8.2). It comes from a bound that assumes all modes in
/// phase, or from the exact displacements in the middle of the step. Checked in
/// tests/unit/interpolation_check_test.cpp.
class InterpolationCheck {
 public:
  /// `modal` must outlive it; `tolerance` is that of outputs, relative to the displacement scale.
  InterpolationCheck(const dynamics::ModalSystem& modal, double tolerance);

  /// True if the bound is small enough. `of_loads`: the part of the Hermite interpolation error due
  /// to loads, m.
  bool is_bounded(const dynamics::ContactPropagator& flow, const TriedStep& step, double of_loads);
  /// True if the quintic is accurate enough in the middle of the step, if necessary with a
  /// breakpoint there, which it sets. `constant_force`: modal; nullptr: none.
  bool is_close(TriedStep& step, const Eigen::ArrayXd* constant_force);
  /// The ratio of error to bound from the last of these two calls.
  double error() const { return error_; }

 private:
  /// The rounding of the displacements of stops in a step, m.
  double rounding(const TriedStep& step) const;
  /// Computes the accelerations `a` of the stops without contact, m/s^2.
  void find_accelerations(double t, const ModalState& state, const Eigen::ArrayXd* constant_force, Eigen::ArrayXd& a);

  const dynamics::ModalSystem& modal_;
  double tolerance_;
  Eigen::ArrayXd squares_;   ///< omega^2
  bool is_strongly_damped_;  ///< a mode decays so fast that bounds in terms of omega are too weak
  Eigen::ArrayXd modal_acceleration_, a_, a_end_;
  double error_ = 0.0;
};

}  // namespace butee::integrators

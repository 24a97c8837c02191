#pragma once

#include "butee/core/types.hpp"

namespace butee::time {

/// The state of a run: everything that the next step depends on.
struct State {
  double t = 0.0;  ///< s
  Vector x;        ///< displacements, m or rad
  Vector v;        ///< velocities
  Vector a;        ///< accelerations; the algorithmic ones for Newmark methods
  Vector memory;   ///< further memory of a method, if any
  Vector contact;  ///< phases and memory of contacts with friction or dissipation (ContactEvents), if any
};

/// A step to take: its length and its end (fixed steps end at n h, so t_end may differ from t + h
/// in the last bit).
///
/// An adaptive method may end it earlier. It may take several internal steps within it, unless
/// `single` is set because observers need the whole state after each.
struct Step {
  double h = 0.0;      ///< s
  double t_end = 0.0;  ///< s
  bool single = false;
  bool is_part = false;  ///< part of the last step from the same state, which was accepted but passed a change of phase
};

enum class StepStatus {
  ok,
  not_finite,     ///< a NaN or an infinity occurred
  newton_failed,  ///< Newton's iteration did not meet its tolerances
  singular        ///< an effective matrix was not positive definite
};

/// Outcome of a step.
struct StepReport {
  StepStatus status = StepStatus::ok;
  double error = 0.0;         ///< error measure of the method, for its StepController
  double proposal = 0.0;      ///< s; length of the next try that the method proposes, 0 if none
  int newton_iterations = 0;  ///< linear solves of Newton's iteration
  bool kept_failure = false;  ///< continued although Newton failed
  int inner_steps = 1;        ///< steps that the method took within the step
  int inner_rejected = 0;     ///< internal steps that were rejected and repeated
  Index worst_dof = -1;       ///< DOF with the largest Newton residual, of a failed iteration
};

}  // namespace butee::time

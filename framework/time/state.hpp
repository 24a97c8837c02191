#pragma once

#include "butee/core/types.hpp"

namespace butee::time {

/// The state of a run: everything that the next step depends on.
struct State {
  double t = 0.0;  ///< s
  Vector x;        ///< displacements, m or rad
  Vector v;        ///< velocities
  Vector a;        ///< accelerations; of Newmark methods the algorithmic ones
  Vector memory;   ///< what a method carries beyond that, if anything
  Vector contact;  ///< phases and memory of contacts with friction or dissipation (ContactEvents), if any
};

/// A step to take: its length and the instant it ends at (a fixed step counts n h, so t_end is not t + h to the last
/// bit).
///
/// An adaptive method may end it earlier, and may take several steps of its own within it unless it is to take a single
/// one, as it is where observers have to see the whole state at each.
struct Step {
  double h = 0.0;      ///< s
  double t_end = 0.0;  ///< s
  bool single = false;
  bool is_part = false;  ///< of the last step from the same state, which was accepted but passed a change of phase
};

enum class StepStatus {
  ok,
  not_finite,     ///< a NaN or an infinity came up
  newton_failed,  ///< Newton's iteration did not meet its tolerances
  singular        ///< an effective matrix was not positive definite
};

/// What became of a step.
struct StepReport {
  StepStatus status = StepStatus::ok;
  double error = 0.0;         ///< the method's own measure, for its StepController
  double proposal = 0.0;      ///< s; the length of the next try that the method itself proposes, if it does
  int newton_iterations = 0;  ///< linear solves of Newton's iteration
  bool kept_failure = false;  ///< went on although Newton failed
  int inner_steps = 1;        ///< that the method took within the step
  int inner_rejected = 0;     ///< and those it redid
  Index worst_dof = -1;       ///< where Newton's residual was the largest, of a failed iteration
};

}  // namespace butee::time

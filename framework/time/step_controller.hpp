#pragma once

#include <butee/export.hpp>

#include "butee/time/state.hpp"

namespace butee::time {

/// Whether a step stands, and the length of the next try.
struct StepDecision {
  bool accept = true;
  double next_h = 0.0;  ///< s; may be infinite where nothing bounds it
};

/// Judges a step by StepReport::error and proposes the next. Immutable: memory of a method lives in State::memory.
class BUTEE_EXPORT StepController {
 public:
  virtual ~StepController() = default;
  /// Called for steps that came out finite; others are rejected and halved without asking.
  virtual StepDecision decide(double h, const StepReport& report) const = 0;
};

}  // namespace butee::time

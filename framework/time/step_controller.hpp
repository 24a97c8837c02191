#pragma once

#include <butee/export.hpp>

#include "butee/time/state.hpp"

namespace butee::time {

/// Whether a step is accepted, and the length of the next try.
struct StepDecision {
  bool accept = true;
  double next_h = 0.0;  ///< s; may be infinite if nothing bounds it
};

/// Judges a step by StepReport::error and proposes the next. Immutable: memory of a method is in
/// State::memory.
class BUTEE_EXPORT StepController {
 public:
  virtual ~StepController() = default;
  /// Called for steps with finite results; others are rejected and halved without this call.
  virtual StepDecision decide(double h, const StepReport& report) const = 0;
};

}  // namespace butee::time

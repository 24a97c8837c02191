#pragma once

#include <optional>
#include <string>

#include "../session.hpp"

namespace butee::app::check {

/// What a run would cost, from a trial with the observers that it would have. Steps of an adaptive method are foretold
/// only where the trial covers enough of the run, has seen a stop close if there is one, and took steps at a steady
/// rate: what it cannot know within a factor of 1.5 stays empty.
struct Estimate {
  double setup_seconds = 0.0, trial_seconds = 0.0;
  std::optional<double> run_seconds, steps;  ///< of the whole run
  bool whole = false;                        ///< the trial reached the end: nothing is estimated
  bool steps_known = false;                  ///< fixed steps
  double part = 0.0;                         ///< of the time that the trial went through
  std::optional<double> rows, bytes;         ///< of history.csv
  std::string choice;                        ///< what `auto` chose, and why
  std::string failure;  ///< why a run would be refused, or failed in the trial; empty where it went well
};

Estimate estimate(Session& session, const model::System& system);

}  // namespace butee::app::check

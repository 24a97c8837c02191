#pragma once

#include <string>

#include "../session.hpp"

namespace butee::app::check {

/// What a run would cost, from a trial of a fraction of a second.
struct Estimate {
  double setup_seconds = 0.0, run_seconds = 0.0;
  double steps = 0.0;        ///< of the whole run
  bool whole = false;        ///< the trial reached the end: nothing is estimated
  bool steps_known = false;  ///< fixed steps
  double trial_seconds = 0.0;
  double rows = 0.0, bytes = 0.0;  ///< of history.csv
  std::string choice;              ///< what `auto` chose, and why
  std::string failure;             ///< why a run would be refused, or failed in the trial; empty where it went well
};

Estimate estimate(Session& session, const model::System& system);

}  // namespace butee::app::check

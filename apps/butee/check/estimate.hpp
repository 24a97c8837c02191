#pragma once

#include <optional>
#include <string>

#include "../session.hpp"

namespace butee::app::check {

/// The cost of a run, estimated from a trial of a second at most in a temporary folder, with all files of the
/// run. Estimates of time and of the number of steps are given only if they can be expected to hold within a
/// factor of 1.5: if the trial has seen a stop close (provided the scene has stops), if its pace was even
/// (Pace), and if, for an adaptive method, it covered a third of the run.
struct Estimate {
  std::optional<double> seconds;  ///< of the whole process: reading, set-up, integration, files; without --trust
  std::optional<double> steps;    ///< of the whole run
  double trial_seconds = 0.0;     ///< time spent in the integration
  bool whole = false;             ///< the trial reached the end: nothing is estimated
  bool steps_known = false;       ///< the number of steps is exact (fixed steps)
  double part = 0.0;              ///< fraction of the simulated time that the trial covered
  std::optional<double> rows;     ///< rows of results
  std::optional<double> bytes;    ///< size of the files that grow with the run
  std::string choice;             ///< the method that `auto` chose, and the reason
  std::string refusal;            ///< why a run would be refused; empty if it would not
  std::string failure;            ///< how the trial failed; empty on success
};

/// `reading_seconds`: time from the start of the process to the session. Throws RunError on an interruption.
Estimate estimate(scene::Scene& session, double reading_seconds);

}  // namespace butee::app::check

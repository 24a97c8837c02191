#pragma once

#include <optional>
#include <string>

#include "../session.hpp"

namespace butee::app::check {

/// The cost of a run, from a trial of a second at most in a temporary folder, with all files of the run.
/// Times and numbers of steps are foretold where they can be expected to hold within a factor of 1.5, and are empty
/// elsewhere: the trial has seen a stop close if there is one, its pace was even (Pace), and with an adaptive method it
/// went through a third of the run.
struct Estimate {
  std::optional<double> seconds;  ///< of the whole process: reading, set-up, integration, files; without --trust
  std::optional<double> steps;    ///< of the whole run
  double trial_seconds = 0.0;     ///< of the integration
  bool whole = false;             ///< the trial reached the end: nothing is estimated
  bool steps_known = false;       ///< fixed steps
  double part = 0.0;              ///< of the time that the trial went through
  std::optional<double> rows;     ///< of results
  std::optional<double> bytes;    ///< of the files that grow with the run
  std::string choice;             ///< what `auto` chose, and why
  std::string failure;            ///< why a run would be refused, or failed in the trial; empty where it went well
};

/// `reading_seconds`: from the start of the process to the session. Throws RunError on an interruption.
Estimate estimate(scene::Scene& session, double reading_seconds);

}  // namespace butee::app::check

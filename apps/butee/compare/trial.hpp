#pragma once

#include <optional>
#include <string>
#include <vector>

#include <butee/record/probes.hpp>

#include "../session.hpp"

namespace butee::app::compare {

/// The compared quantities and instants.
struct Question {
  std::vector<model::ProbeRequest> probes;  ///< one quantity of one node each
  std::vector<std::string> columns;         ///< "mid.u", one for each probe
  std::vector<double> times;                ///< s, ascending
};

/// The question of a scene: the named columns of its history, or the first column if none are named. Throws
/// InputError.
Question question_of(const scene::Scene& session, const std::vector<std::string>& columns);

/// Histories of the columns at the times of a question: values[column][instant].
using Values = std::vector<std::vector<double>>;

/// The result of one run.
struct Answer {
  bool completed = false;
  std::string message;
  Values values;         ///< up to the time that the run reached
  double seconds = 0.0;  ///< set-up and integration
  time::RunReport report;
  linalg::Counters counters;
};

/// Runs once, without files. Ends with "too slow" after more than `time_limit` seconds. `perturbation` (m or
/// rad) is the size of a fixed pattern that is added to the initial displacements.
Answer run_once(scene::Scene& session, const Question& question, double time_limit, double perturbation = 0.0);

/// Repeats the run until its time can be measured reliably; returns the smallest time.
Answer measure(scene::Scene& session, const Question& question, double time_limit);

}  // namespace butee::app::compare

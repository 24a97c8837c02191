#pragma once

#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include <butee/record/probes.hpp>

#include "../session.hpp"

namespace butee::app::compare {

/// Set by Ctrl-C: what is under way ends at the next step.
extern volatile std::sig_atomic_t interrupted;

/// What is compared, and when.
struct Question {
  std::vector<model::ProbeRequest> probes;  ///< one quantity of one node each
  std::vector<std::string> columns;         ///< "mid.u", one for each
  std::vector<double> times;                ///< s, ascending
};

/// The question of a scene: these columns of its history, or the first one where none are named. Throws InputError.
Question question_of(const scene::Scene& session, const std::vector<std::string>& columns);

/// Histories of the columns at the times of a question: values[column][instant].
using Values = std::vector<std::vector<double>>;

/// What a run answered.
struct Answer {
  bool completed = false;
  std::string message;
  Values values;         ///< as far as it came
  double seconds = 0.0;  ///< set-up and integration
  time::RunReport report;
  linalg::Counters counters;
};

/// Runs once, without files. Ends with "too slow" where it takes more than `time_limit` seconds. `perturbation` (m or
/// rad) is added to the initial displacements, with a fixed pattern of signs and sizes.
Answer run_once(scene::Scene& session, const Question& question, double time_limit, double perturbation = 0.0);

/// Runs again until the fastest time can be relied on; the fastest.
Answer measure(scene::Scene& session, const Question& question, double time_limit);

}  // namespace butee::app::compare

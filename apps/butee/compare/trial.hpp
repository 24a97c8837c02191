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
  record::ProbeRequest probe;  ///< one quantity of one node
  std::string column;          ///< "mid.u"
  std::vector<double> times;   ///< s, ascending
};

/// The question of a scene: `column` of its history, or the first one where empty. Throws InputError.
Question question_of(const Session& session, const std::string& column);

/// What a run answered.
struct Answer {
  bool completed = false;
  std::string message;
  std::vector<double> values;  ///< at the times of the question, as far as it came
  double seconds = 0.0;        ///< set-up and integration
  time::RunReport report;
  solve::Counters counters;
};

/// Runs once, without files. Ends with "too slow" where it takes more than `time_limit` seconds. `perturbation` (m or
/// rad) is added to the initial displacements, with a fixed pattern of signs and sizes.
Answer run_once(Session& session, const Question& question, double time_limit, double perturbation = 0.0);

/// Runs again until the fastest time can be relied on; the fastest.
Answer measure(Session& session, const Question& question, double time_limit);

}  // namespace butee::app::compare

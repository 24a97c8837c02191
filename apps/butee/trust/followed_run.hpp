#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <butee/record/trust.hpp>

#include "../session.hpp"

namespace butee::app::trust {

/// Systems with more DOFs count as large: their runs are long, and following disturbances of all DOFs
/// multiplies that time.
inline constexpr Index kLargeSystem = 1000;

/// The instants at which runs are compared (s, ascending, including 0 and end_time): the output times, and
/// instants between them if the output times are few.
std::vector<double> compared_times(const scene::Scene& session);

/// Instants that divide the run into equal intervals, including 0 and end_time; fewer for a large system.
std::vector<double> state_times(const scene::Scene& session, Index size);

/// A scalar result of a whole run, such as a peak.
struct WholeNumber {
  std::string name;
  double value;
  bool is_count;
  double rounding = 0.0;  ///< absolute, of a difference of nearly equal numbers
};

/// The results of a run, up to the instant that it reached.
struct FollowedRun {
  bool completed = false;
  std::string message;  ///< reason if not completed
  std::string choice;   ///< the method chosen by `auto`
  Index size = 0;       ///< free DOFs
  double work = 0.0;    ///< evaluations and solutions, times the number of DOFs; independent of the machine
  record::Histories histories;
  std::vector<WholeNumber> numbers;
  Eigen::MatrixXd x, v;             ///< states, one column for each requested instant
  std::vector<double> state_times;  ///< s
};

/// Results of a run that are stored in addition to the rows of its probes.
struct Wanted {
  bool states = false;   ///< whole states at state_times()
  bool numbers = false;  ///< scalar results of the whole run
  bool impacts = false;  ///< include the number of impacts, for which the method takes single steps
};

/// Runs the scene from initial displacements perturbed by `disturbance` (m or rad). Gives up if its work
/// exceeds `most`. Throws RunError on an interruption, InputError if the method refuses the scene.
FollowedRun follow(scene::Scene& session, double disturbance, double most, Wanted wanted);

}  // namespace butee::app::trust

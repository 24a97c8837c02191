#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <butee/record/trust.hpp>

#include "../session.hpp"

namespace butee::app::trust {

/// Systems of more DOFs are large: runs are long, and a disturbance of all DOFs makes them many times longer.
inline constexpr Index kLargeSystem = 1000;

/// The instants at which runs are compared (s, ascending, 0 and end_time among them): the output times, and between
/// them where those are few.
std::vector<double> compared_times(const scene::Scene& session);

/// Instants that part the run into equal pieces, fewer for a large system, 0 and end_time among them.
std::vector<double> state_times(const scene::Scene& session, Index size);

/// A number that stands for a whole run, such as a peak.
struct WholeNumber {
  std::string name;
  double value;
  bool is_count;
};

/// A run, as far as it was followed.
struct FollowedRun {
  bool completed = false;
  std::string message;  ///< why not
  std::string choice;   ///< the method that `auto` took
  Index size = 0;       ///< free DOFs
  double work = 0.0;    ///< evaluations and solutions, times the number of DOFs; the same on every machine
  record::Histories histories;
  std::vector<WholeNumber> numbers;
  Eigen::MatrixXd x, v;             ///< states, a column for each instant asked for
  std::vector<double> state_times;  ///< s
};

/// Results of a run that are kept beside the rows of its probes.
struct Wanted {
  bool states = false;   ///< whole states at state_times()
  bool numbers = false;  ///< those of the whole run
  bool impacts = false;  ///< their number too, for which methods take steps one by one
};

/// Runs the scene from a start that is displaced by `disturbance` (m or rad). Gives up where its work exceeds `most`.
/// Throws RunError on an interruption, InputError where the method refuses the scene.
FollowedRun follow(scene::Scene& session, double disturbance, double most, Wanted wanted);

}  // namespace butee::app::trust

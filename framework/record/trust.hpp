#pragma once

#include <array>
#include <string>
#include <vector>

#include <butee/export.hpp>

namespace butee::record {

/// How far the answer of a run can be trusted, found by running the scene again with a tightened step or tolerance and
/// from starts that differ a little.
struct Trust {
  /// A quantity that chaos leaves alone: its value in the run, and the smallest and largest of all runs.
  struct Statistic {
    std::string name;
    double value, least, greatest;
  };

  double accuracy = 0.0;       ///< asked for, relative to the peak
  double horizon = 0.0;        ///< s; up to there the tightened run differs by less
  bool to_the_end = false;     ///< the horizon is the end of the run
  double difference = 0.0;     ///< the largest difference up to the horizon, relative to the peak
  double growth_rate = 0.0;    ///< 1/s, of small differences, by a straight line through their logarithm
  double amplification = 0.0;  ///< the largest difference of starts that differ, over the difference of these
  bool chaotic = false;        ///< at that rate differences grow ten thousandfold and more before the end
  std::string tightened;       ///< what was tightened: "time_step 1e-05 -> 5e-06"
  std::vector<Statistic> statistics;
};

/// The displacements of the probes at the output times: a row an instant, a column a probe.
struct Courses {
  std::vector<double> times;                ///< s
  std::vector<std::vector<double>> values;  ///< by probe
};

/// Fills horizon and difference from the courses of the run and of the tightened one, growth and chaos from two runs
/// whose starts differ from the scene's by `perturbation` (m or rad) to either side. Those are compared with each
/// other: a method may take a start at which everything is displaced for another scene than one at which little moves.
BUTEE_EXPORT Trust judge(const Courses& run, const Courses& tightened, const std::array<Courses, 2>& perturbed,
                         double perturbation, double accuracy);

/// A few sentences for a person.
BUTEE_EXPORT std::string describe(const Trust& trust);

}  // namespace butee::record

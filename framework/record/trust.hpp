#pragma once

#include <array>
#include <string>
#include <vector>

#include <butee/export.hpp>

#include "butee/record/growth.hpp"

namespace butee::record {

/// How far the answer of a run can be trusted, found by running the scene again: with a tightened step or tolerance, by
/// a method of another family, and from starts that differ a little.
struct Trust {
  /// A quantity of the whole run: its value, and the smallest and largest that it can be.
  struct Statistic {
    std::string name;
    double value, least, greatest;
    bool is_count = false;  ///< a whole number, of which least and greatest are those of the runs
  };

  double accuracy = 0.0;       ///< asked for, relative to the peak
  double horizon = 0.0;        ///< s; up to there the error is bounded by that
  bool to_the_end = false;     ///< the horizon is the end of the run
  double difference = 0.0;     ///< largest difference to the other runs up to the horizon, relative to the peak
  double bound = 0.0;          ///< of the error up to the horizon, relative to the peak
  double end_bound = 0.0;      ///< and to the end; infinite where it is not known
  double end = 0.0;            ///< s, of the run
  double growth_rate = 0.0;    ///< 1/s, of small differences, where they grow exponentially beyond doubt; else 0
  double growth_until = 0.0;   ///< s, to where they do
  double amplification = 1.0;  ///< the largest size of a small disturbance of the start, relative to its first
  bool chaotic = false;        ///< they do grow exponentially
  std::string tightened;       ///< what was tightened: "time_step 1e-05 -> 5e-06"
  std::string other;           ///< method of the other family; empty where none takes the scene
  std::vector<Statistic> statistics;
};

/// The displacements of the probes at the output times: a row an instant, a column a probe.
struct Histories {
  std::vector<double> times;                ///< s
  std::vector<std::vector<double>> values;  ///< by probe
};

/// The runs of one scene that a judgement rests on. Those that there are not have no times.
struct TrustRuns {
  Histories run;          ///< that is to be judged
  Histories tightened;    ///< its method, with a smaller step or tolerance
  Histories other;        ///< another family's method
  Histories again;        ///< that method, with another order or tolerance, from a start that differs by rounding
  bool is_exact = false;  ///< the other method has no truncation error
  Growth growth;          ///< of small disturbances
};

/// Fills horizon, bound and growth. The bound of the error at t is
///
///     b(t) = s d(t) + 3 max(e(t), 4 eps (1 + omega t) A(t) peak)
///
/// with d, e the largest differences up to t, d of the run to the tightened and the other one, e of the other to its
/// repetition, and A the largest growth of a disturbance between two instants up to t. Where the other method has no
/// truncation error d holds the error but for e, and s = 1.5 allows for the largest difference between two rows (of a
/// sinusoid 4 rows a period show at least cos(45 degrees)); elsewhere s = 3, twice the 3/2 by which halving the step of
/// a method of order 1 to 2 understates an error. Without another method s = 10.
BUTEE_EXPORT Trust judge(const TrustRuns& runs, double accuracy);

/// The largest difference of two runs in any probe at any instant that both came to.
BUTEE_EXPORT double largest_difference(const Histories& a, const Histories& b);

/// Sets least and greatest of a statistic from its values in all runs, the judged one first. Counts take the range of
/// the runs; other quantities get `factor` times that range to both sides, and not less than `floor`.
BUTEE_EXPORT Trust::Statistic bracket(const std::string& name, const std::vector<double>& values, bool is_count,
                                      double factor, double floor);

/// A few sentences for a person.
BUTEE_EXPORT std::string describe(const Trust& trust);

}  // namespace butee::record

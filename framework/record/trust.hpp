#pragma once

#include <array>
#include <string>
#include <vector>

#include <butee/export.hpp>

#include "butee/record/growth.hpp"

namespace butee::record {

/// How far the result of a run can be trusted, found by running the scene again: with a smaller
/// step or tolerance, by a method of another family, and from slightly different starts.
struct Trust {
  /// A quantity of the whole run: its value, and its smallest and largest possible value.
  struct Statistic {
    std::string name;
    double value, least, greatest;
    bool is_count = false;  ///< an integer; least and greatest are then those of the runs
  };

  double accuracy = 0.0;       ///< requested accuracy, relative to the peak
  double horizon = 0.0;        ///< s; up to this time the error is within the accuracy
  bool to_the_end = false;     ///< the horizon is the end of the run
  double difference = 0.0;     ///< largest difference from the other runs up to the horizon, relative to the peak
  double bound = 0.0;          ///< bound on the error up to the horizon, relative to the peak
  double end_bound = 0.0;      ///< the same up to the end; infinite if not known
  double end = 0.0;            ///< s, end of the run
  double growth_rate = 0.0;    ///< 1/s, of small differences if their exponential growth is certain; else 0
  double growth_until = 0.0;   ///< s, end of the exponential growth
  double amplification = 1.0;  ///< the largest size of a small disturbance of the start, relative to its initial size
  bool chaotic = false;        ///< small differences grow exponentially
  std::string tightened;       ///< the tightened parameter: "time_step 1e-05 -> 5e-06"
  std::string other;           ///< method of the other family; empty if none can run the scene
  std::vector<Statistic> statistics;
};

/// Displacements and rotations of the probes at the output times.
struct Histories {
  /// Each is compared with others of its kind. A moving base makes two kinds of displacements: those of the equations
  /// of motion, and those in the other frame.
  enum Kind : std::size_t { displacement, rotation, other_displacement };

  std::vector<double> times;                ///< s
  std::vector<std::vector<double>> values;  ///< one for each displacement, m, and rotation, rad
  std::vector<Kind> kinds{};                ///< of each of them; displacements if empty
  /// The largest of each kind in the whole structure, m or rad; 0 where only `values` are known.
  std::array<double, 3> largest_of_kind{};
};

/// The runs of one scene on which a judgement is based. Missing runs have no times.
struct TrustRuns {
  Histories run;          ///< the run to be judged
  Histories tightened;    ///< with its method and a smaller step or tolerance
  Histories other;        ///< with a method of another family
  Histories again;        ///< with that other method, at another order or tolerance, from a start that differs by
                          ///< rounding
  bool is_exact = false;  ///< the other method has no truncation error
  Growth growth;          ///< of small disturbances
};

/// Fills horizon, bound and growth. The bound of the error at t is
///
///     b(t) = s d(t) + 3 max(e(t), 4 eps (1 + omega t) A(t) peak)
///
/// with d, e the largest differences up to t: d of the run from the tightened and the other one, e
/// of the other from its repetition; A is the largest growth of a disturbance between two instants
/// up to t. Differences are relative to the peak of each displacement or rotation, but at least a thousandth of the
/// largest peak of its kind; `peak` is then 1. If the other method has no truncation error, d contains the whole error
/// except e, and s = 1.5 allows for the largest difference between two rows (4 rows a period of a sinusoid show at
/// least cos(45 degrees)); otherwise s = 3, twice the factor 3/2 by which halving the step of a method of order 1 to 2
/// underestimates an error. Without another method s = 10.
BUTEE_EXPORT Trust judge(const TrustRuns& runs, double accuracy);

/// The largest difference of two runs in any probe at any instant that both reached.
BUTEE_EXPORT double largest_difference(const Histories& a, const Histories& b);

/// Sets least and greatest of a statistic from its values in all runs, the judged one first. Counts
/// take the range of the runs; other quantities are extended by `factor` times that range to both
/// sides, and by not less than `floor`.
BUTEE_EXPORT Trust::Statistic bracket(const std::string& name, const std::vector<double>& values, bool is_count,
                                      double factor, double floor);

/// A summary of a few sentences for the user.
BUTEE_EXPORT std::string describe(const Trust& trust);

}  // namespace butee::record

#pragma once

#include <vector>

#include <butee/export.hpp>

namespace butee::record {

/// The growth of a small disturbance of a motion: ln of its size over its initial size, at instants
/// of the run. The disturbance is made small again at each of them, so that it never saturates and
/// never falls below step noise.
struct Growth {
  std::vector<double> times;  ///< s, ascending, from 0 on
  std::vector<double> logs;   ///< ln(size/initial size), of displacements and velocities together; first entry 0
  std::vector<double>
      displacement_logs;   ///< the same for omega times the displacements alone, from the second instant on
  double displaced = 1.0;  ///< largest difference of the probes after a displaced start, divided by that displacement
  double omega = 0.0;      ///< rad/s, ratio of largest velocity to largest displacement

  /// The logarithm of the largest ratio of its size at an instant up to `t` to its size at an
  /// earlier instant: the largest growth of an error made during the run.
  BUTEE_EXPORT double log_between(double t) const;
  /// The largest size of the displacements relative to the initial size, or `displaced` if that is
  /// larger; at least 1. Velocities are excluded: across a stiff stop two motions that differ only
  /// by a delay differ in velocity by twice its value.
  BUTEE_EXPORT double amplification() const;

  /// Exponential growth, proportional to e^(rate t).
  struct Rate {
    double rate = 0.0;   ///< 1/s; 0 if exponential growth is not certain
    double until = 0.0;  ///< s, end of the exponential growth
  };
  /// Evaluated over the whole run and, if not found there, up to the time at which the size comes
  /// within a factor e of its largest: motion may settle later.
  ///
  /// Computed from the means of eight equal parts of that time, without the first. A straight line
  /// in t is accepted if it rises by more than ln 20 (a disturbance of integrable motion grows like
  /// t, between these means by less than ln 5) and by more than 2.5 standard errors of the six
  /// increments, and fits better than a straight line in ln t.
  BUTEE_EXPORT Rate exponential() const;

 private:
  double rate_until(double end) const;
};

}  // namespace butee::record

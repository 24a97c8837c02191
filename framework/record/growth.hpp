#pragma once

#include <vector>

#include <butee/export.hpp>

namespace butee::record {

/// How a small disturbance of a motion grows: ln of its size over its first size, at instants of the run. The
/// disturbance is made small again at each of them, so that it never saturates and never falls below step noise.
struct Growth {
  std::vector<double> times;  ///< s, ascending, from 0 on
  std::vector<double> logs;   ///< ln(size/first size), of displacements and velocities together; 0 at first
  std::vector<double>
      displacement_logs;   ///< the same of omega times the displacements alone, from the second instant on
  double displaced = 1.0;  ///< largest difference of the probes from a start that is displaced, over that displacement
  double omega = 0.0;      ///< rad/s, ratio of largest velocity and largest displacement

  /// The largest ratio of its size at an instant up to `t` to its size at one before, as a logarithm: what an error
  /// made on the way can have grown by.
  BUTEE_EXPORT double log_between(double t) const;
  /// The largest size of the displacements relative to the first size, or `displaced` where that is larger; at least 1.
  /// Velocities are left out: across a stiff stop two motions that are the same but for a delay differ in velocity by
  /// twice its value.
  BUTEE_EXPORT double amplification() const;

  /// Growth like e^(rate t).
  struct Rate {
    double rate = 0.0;   ///< 1/s; 0 where the growth is not exponential beyond doubt
    double until = 0.0;  ///< s, to where it goes on
  };
  /// Looked for over the whole run and, where it is not found there, up to where the size comes within e of its
  /// largest: motion may settle later on.
  ///
  /// Taken from the means of eight equal parts of that time, without the first. A straight line in t counts where it
  /// rises by more than ln 20 (a disturbance of integrable motion grows like t, between these means by less than ln 5),
  /// by more than 2.5 standard errors of the six increments, and fits better than a straight line in ln t.
  BUTEE_EXPORT Rate exponential() const;

 private:
  double rate_until(double end) const;
};

}  // namespace butee::record

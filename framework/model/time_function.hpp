#pragma once

#include <optional>
#include <span>
#include <vector>

#include <butee/export.hpp>

namespace butee::model {

/// amplitude cos(angular_frequency t + phase); rad/s and rad.
struct Harmonic {
  double amplitude, angular_frequency, phase;
};

/// The course of a load in time, in N (on u) or N m (on theta), or a plain factor under `in_time`.
class BUTEE_EXPORT TimeFunction {
 public:
  virtual ~TimeFunction() = default;

  /// The value at time `t`, s.
  virtual double value(double t) const = 0;

  /// True where it is zero at all times, so that the load can be left out.
  virtual bool vanishes() const { return false; }

  /// The Taylor coefficients of value(t + s h) in s, from the right where it jumps: coefficients[k] = h^k
  /// value^(k)(t)/k!. False where it has none to give; methods that need them then refuse the scene.
  virtual bool taylor(double t, double h, std::span<double> coefficients) const {
    (void)t, (void)h, (void)coefficients;
    return false;
  }

  /// Of a pure harmonic, so that methods may integrate it exactly; nothing for all others.
  virtual std::optional<Harmonic> harmonic() const { return std::nullopt; }

  /// True where it is a polynomial of degree two or less between discontinuities(); methods that need that refuse all
  /// others but pure harmonics.
  virtual bool is_piecewise_parabolic() const { return false; }

  /// The instants at which the value or one of its derivatives jumps, ascending.
  virtual std::vector<double> discontinuities() const { return {}; }
};

}  // namespace butee::model

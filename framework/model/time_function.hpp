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

/// The time history of a load, in N (on u) or N m (on theta), or a factor without unit under
/// `in_time`.
class BUTEE_EXPORT TimeFunction {
 public:
  virtual ~TimeFunction() = default;

  /// The value at time `t`, s.
  virtual double value(double t) const = 0;

  /// True if it is zero at all times, so that the load can be omitted.
  virtual bool vanishes() const { return false; }

  /// The Taylor coefficients of value(t + s h) in s, from the right at a discontinuity:
  /// coefficients[k] = h^k value^(k)(t)/k!. False if it has none; methods that need them then
  /// refuse the scene.
  virtual bool taylor(double t, double h, std::span<double> coefficients) const {
    (void)t, (void)h, (void)coefficients;
    return false;
  }

  /// The parameters of a pure harmonic, so that methods may integrate it exactly; empty for all
  /// other functions.
  virtual std::optional<Harmonic> harmonic() const { return std::nullopt; }

  /// True if it is a polynomial of degree two or less between discontinuities(). Methods that need
  /// this refuse all other functions except pure harmonics.
  virtual bool is_piecewise_parabolic() const { return false; }

  /// The instants at which the value or one of its derivatives jumps, ascending.
  virtual std::vector<double> discontinuities() const { return {}; }
};

}  // namespace butee::model

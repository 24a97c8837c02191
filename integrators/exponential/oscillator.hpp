#pragma once

#include <array>
#include <cmath>

namespace butee::integrators {

/// Solves q'' + 2 delta q' + omega^2 q = f_0 + f_1 t + f_2 t^2 in scalars: dynamics::ModalMotion
/// for one mode.
class Oscillator {
 public:
  struct Point {
    double q, v;
  };

  /// omega and delta in 1/s.
  Oscillator(double omega, double delta)
      : square_(omega * omega), decay_(delta), turning_(square_ - delta * delta), rate_(omega + delta) {}

  /// True if move() is accurate to rounding: for short times, or for a decaying oscillation away
  /// from critical damping.
  bool can_move(double t) const { return is_slow(t) || turning_ > 0.01 * square_; }
  Point move(Point from, const std::array<double, 3>& force, double t) const {
    return is_slow(t) ? by_series(from, force, t) : in_closed_form(from, force, t);
  }

 private:
  bool is_slow(double t) const { return rate_ * t <= 0.3; }

  /// Taylor series in s = time/t; terms beyond kPowers are below rounding.
  Point by_series(Point from, const std::array<double, 3>& force, double t) const {
    constexpr int kPowers = 12;
    const double damping = 2.0 * decay_ * t, stiffness = square_ * t * t,
                 forcing[] = {force[0] * t * t, force[1] * t * t * t, force[2] * t * t * t * t};
    double before = from.q, latest = t * from.v, q = before + latest, v = latest;
    for (int k = 0; k + 2 <= kPowers; ++k) {
      const double next =
          ((k < 3 ? forcing[k] : 0.0) - (k + 1) * damping * latest - stiffness * before) / ((k + 1) * (k + 2));
      q += next;
      v += (k + 2) * next;
      before = latest;
      latest = next;
    }
    return {q, v / t};
  }

  /// The particular polynomial solution plus the free oscillation that satisfies the initial
  /// values.
  Point in_closed_form(Point from, const std::array<double, 3>& force, double t) const {
    const double r = 1.0 / square_, led2 = force[2] * r, led1 = (force[1] - 4.0 * decay_ * led2) * r,
                 led0 = (force[0] - 2.0 * decay_ * led1 - 2.0 * led2) * r;
    const double frequency = std::sqrt(turning_), a = from.q - led0, b = (from.v - led1 + decay_ * a) / frequency;
    const double size = std::exp(-decay_ * t), c = size * std::cos(frequency * t), s = size * std::sin(frequency * t);
    return {led0 + t * (led1 + t * led2) + a * c + b * s,
            led1 + 2.0 * t * led2 + (b * frequency - decay_ * a) * c - (a * frequency + decay_ * b) * s};
  }

  double square_, decay_, turning_, rate_;
};

}  // namespace butee::integrators

#include "butee/model/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/core/error.hpp"

namespace butee::model {

Rotation::Rotation(std::vector<double> times, std::vector<double> speeds)
    : times_(std::move(times)), speeds_(std::move(speeds)), angles_(times_.size()) {
  require(!times_.empty() && times_.size() == speeds_.size(), "a rotation has a speed for each instant");
  for (std::size_t i = 1; i < times_.size(); ++i)
    angles_[i] = angles_[i - 1] + 0.5 * (speeds_[i - 1] + speeds_[i]) * (times_[i] - times_[i - 1]);
}

std::ptrdiff_t Rotation::piece_of(double t) const {
  return std::upper_bound(times_.begin(), times_.end(), t) - times_.begin() - 1;
}

double Rotation::acceleration(double t) const {
  const std::ptrdiff_t i = piece_of(t);
  if (i < 0 || i + 1 == std::ssize(times_)) return 0.0;
  const auto k = static_cast<std::size_t>(i);
  return (speeds_[k + 1] - speeds_[k]) / (times_[k + 1] - times_[k]);
}

double Rotation::speed(double t) const {
  const std::ptrdiff_t i = piece_of(t);
  if (i < 0) return speeds_.front();
  const auto k = static_cast<std::size_t>(i);
  return speeds_[k] + acceleration(t) * (t - times_[k]);
}

double Rotation::angle_since_first(double t) const {
  const std::ptrdiff_t i = piece_of(t);
  if (i < 0) return speeds_.front() * (t - times_.front());
  const auto k = static_cast<std::size_t>(i);
  return angles_[k] + (t - times_[k]) * (speeds_[k] + 0.5 * acceleration(t) * (t - times_[k]));
}

double Rotation::angle(double t) const {
  return is_constant() ? speeds_.front() * t : angle_since_first(t) - angle_since_first(0.0);
}

double Rotation::largest_speed() const {
  double largest = 0.0;
  for (const double speed : speeds_) largest = std::max(largest, std::abs(speed));
  return largest;
}

TurningUnbalance::TurningUnbalance(const Rotation& rotation, double moment, double phase, Along along)
    : rotation_(rotation), moment_(moment), phase_(along == Along::y ? phase : phase - 0.5 * std::numbers::pi) {}

double TurningUnbalance::value(double t) const {
  const double speed = rotation_.speed(t), angle = rotation_.angle(t) + phase_;
  return moment_ * (speed * speed * std::cos(angle) + rotation_.acceleration(t) * std::sin(angle));
}

bool TurningUnbalance::vanishes() const {
  return moment_ == 0.0 || rotation_.largest_speed() == 0.0;
}

std::optional<Harmonic> TurningUnbalance::harmonic() const {
  if (!rotation_.is_constant()) return std::nullopt;
  const double speed = rotation_.speed(0.0);
  return Harmonic{moment_ * speed * speed, std::abs(speed), speed < 0.0 ? -phase_ : phase_};
}

bool TurningUnbalance::taylor(double t, double h, std::span<double> coefficients) const {
  // With the fraction s of h: angle = angle(t) + p s + q s^2; the Taylor coefficients follow from
  // c' = -angle' s, s' = angle' c, and m e (Omega^2 c + Omega' s) with Omega^2 = (a + b s)^2.
  const double acceleration = rotation_.acceleration(t), a = rotation_.speed(t), b = acceleration * h;
  const double p = a * h, q = 0.5 * acceleration * h * h, angle = rotation_.angle(t) + phase_;
  double c[3] = {std::cos(angle), 0.0, 0.0}, s[3] = {std::sin(angle), 0.0, 0.0};  // the latest coefficient, the
                                                                                  // previous one ...
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    coefficients[k] = moment_ * (a * a * c[0] + 2.0 * a * b * c[1] + b * b * c[2] + acceleration * s[0]);
    const double n = 1.0 / static_cast<double>(k + 1);
    const double next_c = -n * (p * s[0] + 2.0 * q * s[1]), next_s = n * (p * c[0] + 2.0 * q * c[1]);
    c[2] = c[1], c[1] = c[0], c[0] = next_c;
    s[2] = s[1], s[1] = s[0], s[0] = next_s;
  }
  return true;
}

}  // namespace butee::model

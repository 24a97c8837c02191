#pragma once

#include <vector>

#include "butee/model/time_function.hpp"

namespace butee::model {

/// The speed of shafts about +x, Omega(t) in rad/s, piecewise linear in time: a constant, a ramp or
/// a table.
class BUTEE_EXPORT Rotation {
 public:
  /// `times` (s) ascend and are not empty; the speed is constant before the first and after the
  /// last.
  Rotation(std::vector<double> times, std::vector<double> speeds);

  double speed(double t) const;         ///< Omega, rad/s
  double acceleration(double t) const;  ///< dOmega/dt, rad/s2, from the right
  double angle(double t) const;         ///< the integral of Omega since t = 0, rad
  bool is_constant() const { return times_.size() == 1; }
  /// The instants at which the acceleration jumps, ascending.
  std::vector<double> discontinuities() const { return is_constant() ? std::vector<double>{} : times_; }
  double largest_speed() const;  ///< the largest |Omega|, rad/s

 private:
  /// The last entry of times_ at or before t, -1 before the first.
  std::ptrdiff_t piece_of(double t) const;
  double angle_since_first(double t) const;

  std::vector<double> times_, speeds_, angles_;  ///< angles_ since times_.front()
};

/// One component of the force of a rotating unbalance, N:
/// along y, m e (Omega^2 cos phi + Omega' sin phi); along z, m e (Omega^2 sin phi - Omega' cos
/// phi), with phi = angle + phase.
class BUTEE_EXPORT TurningUnbalance final : public TimeFunction {
 public:
  enum class Along { y, z };

  /// `moment` is m e, kg m; `phase` in rad. `rotation` must outlive this object.
  TurningUnbalance(const Rotation& rotation, double moment, double phase, Along along);

  double value(double t) const override;
  bool vanishes() const override;
  bool taylor(double t, double h, std::span<double> coefficients) const override;
  std::optional<Harmonic> harmonic() const override;
  std::vector<double> discontinuities() const override { return rotation_.discontinuities(); }

 private:
  const Rotation& rotation_;
  double moment_, phase_;  ///< for the z component a quarter turn less than for the y component
};

}  // namespace butee::model

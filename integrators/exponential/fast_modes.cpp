#include "integrators/exponential/fast_modes.hpp"

#include <algorithm>
#include <limits>

#include "integrators/local_error.hpp"

namespace butee::integrators {
namespace {

using time::State;

/// A sine of amplitude 1 and frequency omega differs from the quintic through its x, v and a at two
/// instants dt apart by at most kOfX + kOfV (omega dt) + kOfA (omega dt)^2, and its velocity by
/// omega (kSpeedOfV + kSpeedOfA (omega dt)): norms of Hermite's functions with a reserve, from
/// plugins/exponential/THEORY.md, section 10.
constexpr double kOfX = 2.0, kOfV = 0.4, kOfA = 0.035, kSpeedOfV = 5.0, kSpeedOfA = 0.3;

/// Motion of a mode that moves no DOF by more than this part of its scale is rounding; its acceleration may still be
/// large.
constexpr double kResting = 16.0 * std::numeric_limits<double>::epsilon();

/// Lower bounds of the scales at all instants of a step: those at its start, but at least a thousandth of those at its
/// end. In the first steps scales grow by orders of magnitude.
template <class Scales>
Eigen::ArrayXd within_step(const Scales& at_start, const Scales& at_end) {
  constexpr double kFloor = 1e-3;
  return at_start.array().max(kFloor * at_end.array());
}

Eigen::ArrayXd scales_x(const State& from, const State& to) {
  return within_step(LocalErrorControl::scales_x(from), LocalErrorControl::scales_x(to));
}

Eigen::ArrayXd scales_v(const State& from, const State& to) {
  return within_step(LocalErrorControl::scales_v(from), LocalErrorControl::scales_v(to));
}

}  // namespace

double least_growth(const State& from, const State& to) {
  const auto least = [](const Eigen::ArrayXd& within, const auto& at_end) {
    return (at_end.array() > 0.0).select(within / at_end.array(), 1.0).minCoeff();
  };
  return std::min(least(scales_x(from, to), LocalErrorControl::scales_x(to)),
                  least(scales_v(from, to), LocalErrorControl::scales_v(to)));
}

FastModes::FastModes(const dynamics::DampedModes& modes, double tolerance)
    : modes_(modes), tolerance_(tolerance), highest_(modes.count() > 0 ? modes.speed()[modes.count() - 1] : 0.0) {
  const Index p = modes.count();
  const auto magnitude = [p](const Eigen::MatrixXd& shapes) -> Eigen::MatrixXd {
    return (shapes.topRows(p).array().square() + shapes.bottomRows(p).array().square()).sqrt().matrix().transpose();
  };
  shape_ = magnitude(modes.displacement());
  speed_shape_ = magnitude(modes.velocity());
}

FastModes::Scales FastModes::scales(const State& from, const State& to) const {
  return {tolerance_ * scales_x(from, to), tolerance_ * scales_v(from, to),
          tolerance_ * from.a.cwiseAbs().cwiseMax(to.a.cwiseAbs())};
}

double FastModes::find(const State& from, const State& to, double slow, const Eigen::ArrayXd& amplitudes,
                       time::Detail detail) const {
  if (detail == time::Detail::power) {
    const Eigen::ArrayXd energy = modes_.kinetic() * amplitudes.square();
    double bound = tolerance_ * tolerance_ * energy.sum();
    for (Index k = modes_.count() - 1; k >= 0 && modes_.speed()[k] > slow; --k)
      if ((bound -= energy[k]) < 0.0) return modes_.speed()[k];
    return slow;
  }
  const Scales scale = scales(from, to);
  const Eigen::ArrayXd rounding = kResting / tolerance_ * scale.x;
  // Sums over the modes that are left out, for each DOF.
  Eigen::ArrayXd x = Eigen::ArrayXd::Zero(scale.x.size()), v = x, a = x;
  for (Index k = modes_.count() - 1; k >= 0 && modes_.speed()[k] > slow; --k) {
    const double speed = modes_.speed()[k];
    if ((amplitudes[k] * shape_.col(k).array() <= rounding).all()) continue;
    x += amplitudes[k] * shape_.col(k).array();
    v += amplitudes[k] * speed_shape_.col(k).array();
    a += amplitudes[k] * speed * speed_shape_.col(k).array();
    if (detail == time::Detail::accelerations) {
      if ((x > scale.x).any() || (v > scale.v).any() || (a > scale.a).any()) return speed;
      continue;
    }
    const double dt = kMostTurn / std::max(slow, k > 0 ? modes_.speed()[k - 1] : 0.0);
    if ((kOfX * x + kOfV * dt * v + kOfA * dt * dt * a > scale.x).any()) return speed;
    if (detail == time::Detail::velocities && (kSpeedOfV * v + kSpeedOfA * dt * a > scale.v).any()) return speed;
  }
  return slow;
}

}  // namespace butee::integrators

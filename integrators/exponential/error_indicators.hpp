#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "butee/dynamics/modal_system.hpp"

/// The error indicators that a step of many modes (ExponentialStep) and one of a single DOF (SingleStep) share, with
/// their constants. Derivations: plugins/exponential/THEORY.md, section 8; tests: tests/unit/error_indicators_test.cpp.
namespace butee::integrators {

/// The result of an attempt at a step.
enum class Trial { accepted, too_long, not_finite };

/// Order and error bounds of a step.
struct StepGoal {
  std::size_t orders;  ///< Legendre polynomials that the force is projected onto: 1, 2 or 3
  double middle;     ///< of the middle of a path beside the cubic through its ends, relative to the displacement scale
  double outputs;    ///< of outputs within a step, relative to that
  double tolerance;  ///< of the run
  double run_time;   ///< s
};

/// The displacement and the speed that errors of a stop are relative to.
struct ContactScale {
  double displacement = 0.0, speed = 0.0;

  /// s; infinite at rest
  double characteristic_time() const {
    return speed > 0.0 ? displacement / speed : std::numeric_limits<double>::infinity();
  }
};

/// The characteristic time of the motion in steps of h, at least 1.
inline double characteristic_steps(ContactScale scale, double h) {
  if (scale.speed == 0.0) return 1.0;
  return h * scale.speed < scale.displacement ? scale.displacement / (h * scale.speed) : 1.0;
}

/// The error of an accepted step and its bound, in the same unit.
struct StepError {
  double value, allowed;

  /// A longer step would do as well: the error grows by four with the next step size of the grid, and the rest is a
  /// reserve against oscillation between two sizes.
  bool is_below_growth_limit() const { return value < kGrowthLimit * allowed; }
  double ratio() const { return value / allowed; }

  static constexpr double kGrowthLimit = 0.1;
};

// Convergence of the iteration for the forces.

/// It ends if the paths change by less than this fraction of allowed_change(), or by rounding.
inline constexpr double kConverged = 0.02;
inline constexpr double kRoundingChange = 1e-15;
/// Or if the next sweep, contracting as the last did, would change them by less than this fraction of kConverged.
inline constexpr double kExpected = 0.1;
/// More sweeps reject the step.
inline constexpr int kMostSweeps = 25;
/// The speed scale times h is at least this fraction of sigma times the displacement scale, so that a stop at rest
/// converges.
inline constexpr double kLeastPart = 1e-4;
/// The Hermite functions of the slopes of a cubic are at most 4/27.
inline constexpr double kBump = 4.0 / 27.0;

/// The change of a stop's path, m, whose displacement and whose change of h times the speed by the stop's force are
/// within the tolerance. `stiff` is sigma = (h omega_c)^2 of the stop alone.
inline double allowed_change(double tolerance, double stiff, double h, ContactScale scale) {
  const double of_displacement = std::abs(stiff) * scale.displacement;
  const double of_speed = std::max(h * scale.speed, kLeastPart * of_displacement);
  return tolerance * (of_displacement > of_speed ? of_speed / std::abs(stiff) : scale.displacement);
}

// Steps with contact.

/// Factor c of the model c sigma^2 |b| of the error of h times the speed; the second for a stop that stays closed.
inline constexpr double kOfSpeed = 0.1, kOfSpeedClosed = 0.5;

/// Indicators 1 and 2: the error of a stop's path in a step of h by its quartic coefficient b, as a displacement, m.
inline double path_error(double quartic, double stiff, double h, ContactScale scale, bool stays_closed) {
  const double speed = h * scale.speed;
  const double of_speed = (stays_closed ? kOfSpeedClosed : kOfSpeed) * stiff * stiff;
  return quartic * (of_speed * scale.displacement > speed ? of_speed * scale.displacement / speed : 1.0);
}

/// A path is known to this fraction of its quartic coefficient.
inline constexpr double kPathError = 0.1;

/// Indicator 3: the error, relative to the displacement scale, of a stop that the path misses if contact would have
/// changed its speed times h by `impulse`.
inline double missed_contact_error(const StepGoal& goal, double impulse, double h, double speed) {
  return impulse / (h * speed) * goal.middle / goal.tolerance;
}

// Residual forces.

/// A contact force may be wrong by this fraction of the force that changes the speed by the tolerance in a run.
inline constexpr double kLasting = 0.4;
/// The fraction of a run's error bound for residual forces that one characteristic time, `steps` h, may use.
inline double share_of_run(double h, double steps, double run_time) {
  constexpr double kTimes = 10.0;
  return std::min(1.0, kTimes * h * steps / run_time);
}

// Steps without contact.

/// The error of a quintic through the ends is (omega h)^2 times this fraction of that of the cubic.
inline constexpr double kQuintic = 1.0 / 120.0;

/// The largest |int_0^s (F - P F) ds| of a force F of slope 1 behind any place of the step, and of one that jumps by 1:
/// the impulse that the projection P F hides from outputs within a step.
inline constexpr double kSlopeImpulse = 4.73e-3, kJumpImpulse = 0.0625;

/// The longest step near a stop, s: the slowest mode and the loads turn by kMostTurn at most, so that three values of a
/// path tell where it was between.
inline double longest_near_stops(const dynamics::ModalSystem& modal) {
  constexpr double kMostTurn = 1.5;
  double fastest = modal.frequencies().minCoeff();
  for (const dynamics::ModalHarmonic& harmonic : modal.harmonics())
    fastest = std::max(fastest, harmonic.angular_frequency);
  return fastest > 0.0 ? kMostTurn / fastest : std::numeric_limits<double>::infinity();
}

}  // namespace butee::integrators

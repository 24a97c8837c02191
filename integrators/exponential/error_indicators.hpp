#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "butee/dynamics/modal_system.hpp"

/// The error indicators shared by steps of many modes (ExponentialStep) and steps of a single DOF
/// (SingleStep), with their constants. Derivations: plugins/exponential/THEORY.md, section 8;
/// tests: tests/unit/error_indicators_test.cpp.
namespace butee::integrators {

/// Number of steps in a macro step.
inline constexpr int kMacroStep = 32;

/// The result of an attempt at a step.
enum class Trial { accepted, too_long, not_finite };

/// Error bounds of a step.
struct StepGoal {
  double middle;     ///< bound of a path's departure in the middle from the cubic through its ends, relative to the
                     ///< displacement scale
  double outputs;    ///< error bound of outputs within a step, relative to the displacement scale
  double tolerance;  ///< tolerance of the run
  double run_time;   ///< s
};

/// The displacement (m) and the speed (m/s) to which errors of a stop are relative.
struct ContactScale {
  double displacement = 0.0, speed = 0.0;

  /// In s; infinite at rest.
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

  /// A longer step is acceptable. The error grows fourfold with the next step size of the grid;
  /// kGrowthLimit contains a further reserve of 2.5 against oscillation between two sizes.
  bool is_below_growth_limit() const { return value < kGrowthLimit * allowed; }
  double ratio() const { return value / allowed; }

  static constexpr double kGrowthLimit = 0.1;
};

// Convergence of the iteration for the contact forces.

/// Changes of the paths by rounding only, relative to the displacement scale.
inline constexpr double kRoundingChange = 1e-15;
/// Without Newton's method a sweep changes the path of a stop by sigma/kContraction of the last change: for a free
/// mass (plugins/exponential/constants.py).
inline constexpr double kContraction = 25.9;
/// sigma times these is how far the force moves a path whose end, h times the speed there, or middle changes by 1, the
/// other two staying: for a free mass (plugins/exponential/constants.py).
inline constexpr double kMissingByEnd = 0.0602, kMissingBySpeed = 0.00419, kMissingByMiddle = 0.389;
/// The change of a path, as a fraction of allowed_change(), at which the force of a stop is found anew in any case, so
/// that the recorded force is that of the path.
inline constexpr double kOfForce = 0.25;
/// The iteration ends if the next sweep is expected to change the paths by less than this, as a fraction of
/// allowed_change(): what is left has the same sign in all steps of a long contact, and adds up.
inline double unfinished_change(const StepGoal& goal, double h) {
  constexpr double kOfStep = 0.002, kOfRun = 0.1;
  return std::min(kOfStep, kOfRun * h / goal.run_time);
}
/// More sweeps reject the step.
inline constexpr int kMostSweeps = 25;
/// h times the speed scale is taken as at least this fraction of sigma times the displacement
/// scale, so that the iteration converges for a stop at rest.
inline constexpr double kLeastPart = 1e-9;
/// The rounding error of the quartic coefficient of a path, relative to the sum of |phi q| over the modes. It is 16
/// times the rounding error of a displacement, which is a few epsilon (chosen; THEORY.md, section 8.1).
inline constexpr double kRoundingOfPaths = 64.0 * std::numeric_limits<double>::epsilon();
/// Maximum of the Hermite functions that belong to the slopes of a cubic.
inline constexpr double kBump = 4.0 / 27.0;

/// The change of a stop's path, m, that keeps the errors of the displacement and of h times the
/// speed (changed by the stop's force) within the tolerance. `stiff` is sigma = (h omega_c)^2 of
/// the stop alone.
inline double allowed_change(double tolerance, double stiff, double h, ContactScale scale) {
  const double of_displacement = std::abs(stiff) * scale.displacement;
  const double of_speed = std::max(h * scale.speed, kLeastPart * of_displacement);
  return tolerance * (of_displacement > of_speed ? of_speed / std::abs(stiff) : scale.displacement);
}

/// The same for a law whose force is iterated as a fixed point: the force that is missing at the end moves the path by
/// the expected next change itself, and h times the speed by 2 times as much.
inline double allowed_next_change(double tolerance, double stiff, double h, ContactScale scale) {
  return allowed_change(tolerance, std::max(std::abs(stiff), 2.0), h, scale);
}

// Steps with contact.

/// Factor c in the model c sigma^2 |b| of the error of h times the speed; the second value is for a
/// stop that stays closed.
inline constexpr double kOfSpeed = 0.1, kOfSpeedClosed = 0.5;

/// Indicators 1 and 2: the error of a stop's path in a step of length h, estimated from its quartic
/// coefficient b, as a displacement, m.
inline double path_error(double quartic, double stiff, double h, ContactScale scale, bool stays_closed) {
  const double speed = h * scale.speed;
  const double of_speed = (stays_closed ? kOfSpeedClosed : kOfSpeed) * stiff * stiff;
  return quartic * (of_speed * scale.displacement > speed ? of_speed * scale.displacement / speed : 1.0);
}

/// The speed error of a free mass, divided by its speed and sigma^2, if its stop closes or opens in a step: at most
/// 1.45e-4 up to sigma = 3 at any place of the step (plugins/exponential/constants.py).
inline constexpr double kOfChange = 1.5e-4;
/// Indicator 7: the speed error, relative to the speed scale, of a step in which a stop closes or opens with the speed
/// `speed`, h w' in m.
inline double change_error(double stiff, double speed, double h, ContactScale scale) {
  return speed > 0.0 ? kOfChange * stiff * stiff * speed / (h * scale.speed) : 0.0;
}

/// Bound of |int_0^1 (F - P F) e^(i x s) ds| for a force F that is zero up to some position in the
/// step and has slope 1 behind it, with its projection P F: the error of the impulse of a closing
/// stop on a mode whose phase advances by x (rad) per step.
inline double unresolved_part(double x) {
  return std::min({7.5e-5 * x * x * x, 0.0172, 0.174 / x});
}
/// The same for a force that jumps by 1 at some position in the step.
inline double unresolved_jump(double x) {
  return std::min({5.21e-4 * x * x * x, 0.1433, 2.0 / x});
}
/// Bound of the speed error due to the projection of the force, as a multiple of the error bound of outputs.
inline constexpr double kUnresolved = 1.0;
/// Indicator 4: the error of a stop that is not closed throughout the step, as a displacement, m. `unresolved` is h^2 k
/// times the sum of phi^2 unresolved_part(), and `speed` the largest h w' in the step, m.
inline double slope_error(const StepGoal& goal, double unresolved, double speed, double h, ContactScale scale) {
  const double of_speed = unresolved * speed / (h * scale.speed);
  return of_speed * goal.middle * scale.displacement / (kUnresolved * goal.outputs);
}

/// The error of h times the speed, divided by sigma^2 and the quartic coefficient, if the stop stays closed: at most
/// 3.03e-3 up to sigma = 10 at any phase of the motion (plugins/exponential/constants.py).
inline constexpr double kOfClosed = 3.1e-3;
/// Indicator 9: the speed error, relative to the speed scale, of a step in which a stop stays closed.
inline double closed_error(double quartic, double stiff, double h, ContactScale scale) {
  return quartic != 0.0 ? kOfClosed * stiff * stiff * std::abs(quartic) / (h * scale.speed) : 0.0;
}

/// Uncertainty of a path as a fraction of its quartic coefficient.
inline constexpr double kPathError = 0.1;

/// Indicator 3: the error, relative to the displacement scale, if the path misses a contact that
/// would have changed h times the speed of the stop by `impulse`, m.
inline double missed_contact_error(const StepGoal& goal, double impulse, double h, double speed) {
  return impulse / (h * speed) * goal.middle / goal.tolerance;
}

// Residual forces.

/// Allowed error of a contact force, as a fraction of the constant force that changes the speed by
/// the tolerance in a run.
inline constexpr double kLasting = 0.4;
/// The fraction of the run's error bound for residual forces that one characteristic time, `steps`
/// h, may use.
inline double share_of_run(double h, double steps, double run_time) {
  constexpr double kTimes = 10.0;
  return std::min(1.0, kTimes * h * steps / run_time);
}

// Steps without contact.

/// The error of a quintic through the ends is that of the cubic times this constant times (omega
/// h)^2.
inline constexpr double kQuintic = 1.0 / 120.0;

/// The largest |int_0^s (F - P F) ds| for a force F of slope 1 behind any position in the step, and
/// for one that jumps by 1: the impulse error of the projection P F in outputs within a step.
inline constexpr double kSlopeImpulse = 4.73e-3, kJumpImpulse = 0.0625;

/// The longest step near a stop, s: the phase angles of the slowest mode and of the loads advance
/// by kMostTurn (rad) at most, so that three values of a path determine its course between them.
inline double longest_near_stops(const dynamics::ModalSystem& modal) {
  constexpr double kMostTurn = 1.5;
  double fastest = modal.frequencies().minCoeff();
  for (const dynamics::ModalHarmonic& harmonic : modal.harmonics())
    fastest = std::max(fastest, harmonic.angular_frequency);
  return fastest > 0.0 ? kMostTurn / fastest : std::numeric_limits<double>::infinity();
}

}  // namespace butee::integrators

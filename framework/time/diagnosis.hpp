#pragma once

#include <limits>
#include <optional>
#include <string>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/state.hpp"

namespace butee::time {

/// What is known of a method's stability (IntegratorType), for messages.
struct MethodLimits {
  std::string name;                                            ///< empty where it is not known
  double stability = std::numeric_limits<double>::infinity();  ///< the largest h omega
  double damping = std::numeric_limits<double>::infinity();    ///< the largest h c/m
  bool keeps_tolerance = false;  ///< its error control is relative and meant for the result (finds_first_step)

  bool is_bounded() const { return stability < std::numeric_limits<double>::infinity(); }
};

/// The largest stable steps of linear motion, s.
struct CriticalSteps {
  double open;    ///< with all stops open
  double closed;  ///< and with all of them closed
};

/// 1/h = max over the modes of |Im lambda|/limits.stability + |Re lambda|/limits.damping: exact without damping, safe
/// with it. Nothing for unconditionally stable methods and where the frequencies could not be computed. Dashpots count
/// in systems of up to 100 DOFs.
BUTEE_EXPORT std::optional<CriticalSteps> critical_steps(dynamics::Dynamics& dynamics, const MethodLimits& limits);

/// "h = 1e-3 s is 3 times the critical step of rk4, ...: take ..."; where the step is below it, or the method has none,
/// what else there is to do.
BUTEE_EXPORT std::string describe_remedy(dynamics::Dynamics& dynamics, const MethodLimits& limits, double h);

/// The DOF that holds most of the energy, its rotations and displacements weighed by M and K: "u of string:17".
BUTEE_EXPORT std::string fastest_dof(const dynamics::Dynamics& dynamics, const State& state);

/// Why a step from `from` failed, and what to do about it.
BUTEE_EXPORT std::string describe_failure(dynamics::Dynamics& dynamics, const MethodLimits& limits, const State& from,
                                          const Step& step, const StepReport& report);

/// Why there is no initial acceleration.
BUTEE_EXPORT std::string describe_start(dynamics::Dynamics& dynamics, const State& state);

}  // namespace butee::time

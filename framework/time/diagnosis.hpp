#pragma once

#include <limits>
#include <optional>
#include <string>

#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/time/state.hpp"

namespace butee::time {

/// Stability limits of a method (IntegratorType), for messages.
struct MethodLimits {
  std::string name;                                            ///< empty if not known
  double stability = std::numeric_limits<double>::infinity();  ///< the largest h omega
  double damping = std::numeric_limits<double>::infinity();    ///< the largest h c/m
  bool keeps_tolerance = false;  ///< error control is relative and bounds the error of the result (finds_first_step)

  bool is_bounded() const { return stability < std::numeric_limits<double>::infinity(); }
};

/// The largest stable steps of linear motion, s.
struct CriticalSteps {
  double open;    ///< with all stops open
  double closed;  ///< with all stops closed
};

/// 1/h = max over the modes of |Im lambda|/limits.stability + |Re lambda|/limits.damping: exact without damping, safe
/// with damping of methods with stages; for methods that take damping at the step before (central differences) the
/// exact limit of a mode, safe for overdamped ones. Nothing for unconditionally stable methods and if the frequencies
/// could not be computed. Dashpots count in systems of up to 100 DOFs. `open`, `closed`: the frequencies in these
/// states of the stops, where they are known already.
BUTEE_EXPORT std::optional<CriticalSteps> critical_steps(dynamics::Dynamics& dynamics, const MethodLimits& limits,
                                                         const std::optional<dynamics::FrequencyRange>& open = {},
                                                         const std::optional<dynamics::FrequencyRange>& closed = {});

/// Advice on the step: "h = 1e-3 s is 3 times the critical step of rk4, ...: take ...". If the step
/// is below the critical one, or the method has none, other remedies.
BUTEE_EXPORT std::string describe_remedy(dynamics::Dynamics& dynamics, const MethodLimits& limits, double h);

/// The DOF that holds most of the energy, rotations and displacements weighted by M and K: "u of
/// string:17".
BUTEE_EXPORT std::string fastest_dof(const dynamics::Dynamics& dynamics, const State& state);

/// Why a step from `from` failed, and how to avoid it.
BUTEE_EXPORT std::string describe_failure(dynamics::Dynamics& dynamics, const MethodLimits& limits, const State& from,
                                          const Step& step, const StepReport& report);

/// Why the initial acceleration could not be computed.
BUTEE_EXPORT std::string describe_start(dynamics::Dynamics& dynamics, const State& state);

}  // namespace butee::time

#include "butee/time/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "butee/core/text.hpp"
#include "butee/dynamics/free_motion.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/linalg/general_pairs.hpp"

namespace butee::time {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Damped modes are found densely up to this size.
constexpr Index kDense = 100;
/// Recommended fraction of a critical step.
constexpr double kSafe = 0.9;
/// A larger force is taken to cause overflow.
constexpr double kHuge = 1e150;
/// Motion below it does not grow beyond numbers in one step.
constexpr double kModerate = 1e50;

/// A method whose limit of h c/m without a spring is half that of h omega or less takes damping at the step before, as
/// central differences do: stable for (h omega/stability)^2 + h c/damping <= 1, by the equations of one mode.
bool lags_damping(const MethodLimits& limits) {
  return limits.damping <= 0.5 * limits.stability;
}

/// 1/h for an eigenvalue of the motion.
double rate(const MethodLimits& limits, double imaginary, double real) {
  return std::abs(imaginary) / limits.stability + std::abs(real) / limits.damping;
}

/// For a mode with damping c per mass: lambda^2 + c lambda + omega^2 = 0.
double rate_of_mode(const MethodLimits& limits, double omega, double c) {
  if (lags_damping(limits)) {
    const double of_damping = c / limits.damping;
    return 0.5 * (of_damping + std::hypot(of_damping, 2.0 * omega / limits.stability));
  }
  const double square = omega * omega - 0.25 * c * c;
  if (square >= 0.0) return rate(limits, std::sqrt(square), 0.5 * c);
  return rate(limits, 0.0, 0.5 * c + std::sqrt(-square));
}

/// 1/h for two real eigenvalues, which may belong to one overdamped mode.
double rate_of_pair(const MethodLimits& limits, double one, double other) {
  if (!lags_damping(limits)) return rate(limits, 0.0, std::max(std::abs(one), std::abs(other)));
  return rate_of_mode(limits, std::sqrt(std::abs(one * other)), std::abs(one) + std::abs(other));
}

/// `contacts`: damping of closed contacts, N s/m, or empty.
std::optional<double> dense_rate(dynamics::Dynamics& dynamics, const MethodLimits& limits,
                                 const SparseMatrix& stiffness, const SparseMatrix& contacts) {
  const Index n = dynamics.size();
  Eigen::MatrixXd damping(n, n);
  Vector column(n);
  for (Index i = 0; i < n; ++i) {
    dynamics.damping_force(Vector::Unit(n, i), column);
    damping.col(i) = column;
  }
  if (contacts.nonZeros() > 0) damping += contacts;
  const Eigen::LLT<Eigen::MatrixXd> mass{Eigen::MatrixXd(dynamics.system().mass)};
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  motion.topRightCorner(n, n).setIdentity();
  motion.bottomLeftCorner(n, n) = -mass.solve(Eigen::MatrixXd(stiffness));
  motion.bottomRightCorner(n, n) = -mass.solve(damping);
  if (mass.info() != Eigen::Success || !motion.allFinite()) return std::nullopt;
  const auto values = linalg::eigenvalues(motion);
  if (!values) return std::nullopt;
  double largest = 0.0;
  std::array<double, 2> most = {0.0, 0.0};  // the two largest real eigenvalues
  for (const std::complex<double>& value : *values) {
    if (value.imag() != 0.0) {
      largest = std::max(largest, rate_of_mode(limits, std::abs(value), 2.0 * std::abs(value.real())));
    } else if (const double size = std::abs(value.real()); size > most[0]) {
      most = {size, most[0]};
    } else {
      most[1] = std::max(most[1], size);
    }
  }
  return std::max(largest, rate_of_pair(limits, most[0], most[1]));
}

/// `range`: of the frequencies, where they are known already.
std::optional<double> critical_rate(dynamics::Dynamics& dynamics, const MethodLimits& limits, dynamics::StopState stops,
                                    std::optional<dynamics::FrequencyRange> range) {
  const model::System& system = dynamics.system();
  const bool has_others = system.dashpots.size() > 0 || system.damping.is_modal();
  SparseMatrix contacts;
  if (stops == dynamics::StopState::closed) contacts = dynamics::damping_of_contacts(system);
  if ((dynamics.has_damping() || contacts.nonZeros() > 0) && dynamics.size() <= kDense)
    return dense_rate(dynamics, limits, dynamics::stiffness_with_stops(system, stops), contacts);
  if (!range) range = dynamics::frequency_range(system, stops);
  if (!range) return std::nullopt;
  const double m = system.damping.mass_proportional, k = system.damping.stiffness_proportional;
  // The damping of the highest mode is taken at its frequency with open stops; for closed stops
  // this is conservative. Dashpots of the structure are left out.
  double c = has_others ? 0.0 : m + k * range->highest * range->highest;
  if (contacts.nonZeros() > 0) {
    const auto of_contacts = dynamics::fastest_decay(contacts, system.mass);
    if (!of_contacts) return std::nullopt;
    c = std::max(c, *of_contacts);
  }
  return rate_of_mode(limits, range->highest, c);
}

std::string overflowing_load(dynamics::Dynamics& dynamics, double t) {
  Vector force(dynamics.size());
  dynamics.external_force(t, force);
  for (Index i = 0; i < force.size(); ++i)
    if (!(std::abs(force[i]) < kHuge))
      return "the load on " + dynamics.dof_name(i) + " is " + to_short_text(force[i]) +
             (is_rotation(dynamics.system().dofs.free()[static_cast<std::size_t>(i)].kind) ? " N m" : " N") +
             " at t = " + to_short_text(t) + " s, which is too large to integrate; check [[load]]";
  return {};
}

std::string overflow(dynamics::Dynamics& dynamics, const MethodLimits& limits, const State& from, const Step& step) {
  for (const double t : {from.t, 0.5 * (from.t + step.t_end), step.t_end})
    if (const std::string load = overflowing_load(dynamics, t); !load.empty()) return load;
  const auto critical = critical_steps(dynamics, limits);
  const bool is_stable = !critical || step.h <= critical->closed;
  if (const double x = from.x.lpNorm<Eigen::Infinity>(), v = from.v.lpNorm<Eigen::Infinity>();
      is_stable && std::max(x, v) < kModerate)
    return "the solution is no longer finite, although displacements were at most " + to_short_text(x) +
           " and velocities at most " + to_short_text(v) +
           " at the step before: the method, or a law, load or element of a module, gives a value that is not a number";
  const std::string what =
      "the solution is no longer finite; it moves fastest in " + fastest_dof(dynamics, from) + ". ";
  if (limits.keeps_tolerance)
    return what + limits.name +
           " controls its error, so the motion itself grows without bound: look for what feeds it (cross terms of "
           "bearings, rotating damping, negative damping of a module, friction), or end the run before";
  return what + describe_remedy(dynamics, limits, step.h);
}

std::string singular(dynamics::Dynamics& dynamics, const Step& step) {
  const model::System& system = dynamics.system();
  const SparseMatrix effective =
      system.mass + 0.25 * step.h * step.h * dynamics::stiffness_with_stops(system, dynamics::StopState::closed);
  return "the effective matrix is not positive definite; the least resistance is to the motion of " +
         dynamics::describe_softest_motion(effective, system.dofs) +
         ". Check the masses and stiffnesses there, which may be too far apart for 16 digits, or use a smaller step "
         "than " +
         to_short_text(step.h) + " s";
}

}  // namespace

std::optional<CriticalSteps> critical_steps(dynamics::Dynamics& dynamics, const MethodLimits& limits,
                                            const std::optional<dynamics::FrequencyRange>& of_open,
                                            const std::optional<dynamics::FrequencyRange>& of_closed) {
  if (!limits.is_bounded()) return std::nullopt;
  const bool has_stops = dynamics.stop_count() > 0 || dynamics.obstacles() != nullptr;
  const auto open = critical_rate(dynamics, limits, dynamics::StopState::open, of_open);
  const auto closed = has_stops ? critical_rate(dynamics, limits, dynamics::StopState::closed, of_closed) : open;
  if (!open || !closed) return std::nullopt;
  const auto step = [](double r) { return r > 0.0 ? 1.0 / r : kInfinity; };
  return CriticalSteps{step(*open), step(*closed)};
}

std::string describe_remedy(dynamics::Dynamics& dynamics, const MethodLimits& limits, double h) {
  const bool has_stops = dynamics.stop_count() > 0 || dynamics.obstacles() != nullptr;
  const auto critical = critical_steps(dynamics, limits);
  if (critical && h > critical->closed) {
    std::string text = "h = " + to_short_text(h) + " s is " + to_short_text(h / critical->closed) +
                       " times the critical step of " + limits.name + ", " + to_short_text(critical->closed) + " s" +
                       (dynamics.has_damping() ? " (a safe bound, as there is damping)" : "");
    if (has_stops)
      text += " with all stops closed" +
              (std::isfinite(critical->open) ? " (" + to_short_text(critical->open) + " s with all open)" : "") +
              ", the limit of its stability";
    else
      text += ", the limit of its stability";
    return text + ": take a time_step of " + to_short_text(kSafe * critical->closed) +
           " s or less, or a method that is stable at any step, such as newmark or auto";
  }
  std::string text;
  if (critical)
    text = "h = " + to_short_text(h) + " s is within the stability of " + limits.name + " (critical step " +
           to_short_text(critical->closed) + " s)" + (has_stops ? ", so changes of contact are the cause" : "") + ": ";
  text += "take a time_step of " + to_short_text(0.25 * h) + " s or less, or a method with error control, such as auto";
  if (has_stops) text += "; discrete_gradient cannot gain energy at a stop";
  return text;
}

std::string fastest_dof(const dynamics::Dynamics& dynamics, const State& state) {
  const model::System& system = dynamics.system();
  // Scaled, so that squares of nearly overflowing values remain finite.
  const double speed = std::max(state.v.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min()),
               size = std::max(state.x.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
  const double ratio = size / speed;
  Index largest = 0;
  double most = -1.0;
  for (Index i = 0; i < state.v.size(); ++i) {
    const double v = state.v[i] / speed, x = state.x[i] / size * ratio;
    const double energy = system.mass.coeff(i, i) * v * v + system.stiffness.coeff(i, i) * x * x;
    if (energy > most) {
      most = energy;
      largest = i;
    }
  }
  return dynamics.dof_name(largest);
}

std::string describe_failure(dynamics::Dynamics& dynamics, const MethodLimits& limits, const State& from,
                             const Step& step, const StepReport& report) {
  switch (report.status) {
    case StepStatus::not_finite:
      return overflow(dynamics, limits, from, step);
    case StepStatus::newton_failed:
      return "Newton's iteration did not meet its tolerances within " + std::to_string(report.newton_iterations) +
             " solves" +
             (report.worst_dof >= 0 ? "; the residual is largest in " + dynamics.dof_name(report.worst_dof) : "") +
             ". Use a time_step of " + to_short_text(0.25 * step.h) +
             " s or less; with newmark more max_iterations, looser tolerances, or on_newton_failure = \"keep\"; or a "
             "method without Newton's iteration, such as auto";
    case StepStatus::singular:
      return singular(dynamics, step);
    case StepStatus::ok:
      break;
  }
  std::string text = "the error measure " + to_short_text(report.error) +
                     " stays above the tolerance; it moves fastest in " + fastest_dof(dynamics, from);
  for (const double t : {from.t, step.t_end})
    if (const std::string load = overflowing_load(dynamics, t); !load.empty()) return text + ", and " + load;
  return text + ". Loosen the tolerance, or check for a jump there: a load, or a stop too stiff for its mass";
}

std::string describe_start(dynamics::Dynamics& dynamics, const State& state) {
  std::string text = "the initial acceleration is not finite; ";
  if (const std::string load = overflowing_load(dynamics, state.t); !load.empty()) return text + load;
  for (Index i = 0; i < state.a.size(); ++i)
    if (!std::isfinite(state.a[i]))
      return text + "it is " + to_short_text(state.a[i]) + " in " + dynamics.dof_name(i) +
             "; check the loads, masses and initial values there";
  return text + "check loads, masses and initial values";
}

}  // namespace butee::time

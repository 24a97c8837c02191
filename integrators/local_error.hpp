#pragma once

#include <limits>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/contact_on_the_way.hpp"
#include "integrators/error_account.hpp"

namespace butee::integrators {

/// Step control by the local error of every component, such that the errors of a whole run add up to the tolerance.
///
///     epsilon = max_i |e_i|/S_i        i over displacements, rotations and their velocities
///     smooth steps:    kappa epsilon^((p+1)/q) <= c tolerance h/T
///     changes of contact:    epsilon_c = k epsilon <= half of the balance of the error account
///
/// S_i is the largest |x_i| (|v_i|) so far, at least a thousandth of the largest of its kind. T is the length of the
/// run. The local error of a method of order p is kappa epsilon^((p+1)/q) where its estimate e falls with h^q, so that
/// smooth steps together are wrong by c times the tolerance at most, times the growth of disturbances. A step in which
/// a stop closes or opens does not follow that power; its error is charged to an account that earns c tolerance h/T a
/// step. Steps lie on a ladder where they cost a factorization. The derivation and the measured constants are in
/// integrators/error-control.md; tests/conformance/error_constant_test.cpp measures kappa again.
///
/// Structures of more than kLargest DOFs are measured as a whole,
///
///     epsilon = max(|e_x|_M/largest |x|_M so far, |e_v|_M/largest |v|_M so far),    |y|_M^2 = y^T M y
///
/// and every step keeps epsilon <= tolerance^(q/p), whatever the length of the run,
/// since a fine mesh holds waves that no output shows, in whose rotations a component would be resolved. A step that
/// goes through a stop unseen is redone with half its length (ContactOnTheWay). The memory (previous r, account,
/// scales) is the first part of State::memory. Sources: K. Gustafsson, ACM TOMS 17 (1991) 533-554,
/// doi 10.1145/210232.210242; E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, II.4.
class LocalErrorControl {
 public:
  struct Orders {
    double estimate;        ///< q
    double method;          ///< p
    double constant;        ///< kappa, of undamped oscillation
    double contact_change;  ///< k: the local error across a change of contact over the estimate
    /// Of an explicit method, the h omega at which it is stable within a closed stop: a longer step in which one closes
    /// or opens is redone, whatever its estimate says.
    double stability = std::numeric_limits<double>::infinity();
    /// For structures measured as a whole: the part of tolerance^(q/p) that the estimate of a step may reach.
    double share = 1.0;
  };
  /// Whether steps are taken from a ladder of ratio 2^(1/4), so that factorizations are found again.
  enum class Steps { any, geometric };
  /// `dynamics` must outlive it.
  LocalErrorControl(dynamics::Dynamics& dynamics, const Goal& goal, Orders orders, Steps steps);

  const time::StepController& controller() const { return controller_; }
  /// A step that is short for the stiffest entry of the system, s.
  double first_step() const { return first_step_; }

  /// DOFs up to which every component has a scale of its own.
  static constexpr Index kLargest = 600;
  /// Entries of State::memory for n DOFs.
  static Index memory_size(Index n) { return kScales + 2 * n; }
  /// Fills the memory of a state at the start; it has at least memory_size() entries.
  void start(time::State& state);
  /// Judges a step with the errors e_x and e_v; `to` has its acceleration, or that of `from`. Fills error and proposal
  /// of the report, and the memory of `to`.
  void judge(const time::State& from, time::State& to, double h, ConstVectorRef error_x, ConstVectorRef error_v,
             time::StepReport& report);

  /// The largest |x|_M and |v|_M so far.
  static double norm_x(const time::State& state) { return state.memory[kNormX]; }
  static double norm_v(const time::State& state) { return state.memory[kNormV]; }
  /// The scales of displacements and of velocities that a state carries.
  static auto scales_x(const time::State& state) { return state.memory.segment(kScales, state.x.size()); }
  static auto scales_v(const time::State& state) {
    return state.memory.segment(kScales + state.x.size(), state.x.size());
  }

  /// The smallest tolerance of methods of order 2, whose steps below it are too many to be of use.
  static constexpr double kSecondOrder = 1e-6;
  /// The parameter that all methods with this control share. Tolerances below `smallest` are refused.
  static config::Parameter parameter(double fallback, double smallest);

 private:
  class Proposed final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override {
      return {report.error <= 1.0, report.proposal};
    }
  };
  /// Places in the memory.
  static constexpr Index kOld = 0, kAccount = 1, kNormX = 2, kNormV = 3, kScales = 4;

  /// Whether a contact of a law that is no straight line begins or ends with the step: there its force is like a broken
  /// power of time, which the estimate takes for a smooth function.
  bool touches_anew(const time::State& from, const time::State& to) const;
  double relative_error(ConstVectorRef error_x, ConstVectorRef error_v) const;
  double norm(ConstVectorRef y);
  /// The same of the whole structure; updates the norms that `to` carries.
  double whole_error(const time::State& from, time::State& to, double h, ConstVectorRef error_x, ConstVectorRef error_v,
                     double smooth);
  double any_step(double h, double r, double old, double order) const;
  double grid_step(double h, double r, double order) const;

  const dynamics::Dynamics& dynamics_;
  const dynamics::Obstacles* obstacles_;  ///< null where there are none
  Proposed controller_;
  ContactOnTheWay contact_;
  ErrorAccount account_;
  Orders orders_;
  double power_;        ///< q/(p + 1)
  double first_step_;   ///< s
  double omega_ = 0.0;  ///< 1/s, with all stops closed and supports slipping; 0 where nothing has a stiffness
  Steps steps_;
  ComponentScales scales_;
  std::vector<double> discontinuities_;  ///< instants at which a load or its slope jumps, s
  double whole_;                         ///< bound of epsilon of structures measured as a whole
  bool as_a_whole_;
  Vector scale_x_, scale_v_, work_;
};

}  // namespace butee::integrators

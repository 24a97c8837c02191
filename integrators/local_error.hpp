#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/centre_crossing.hpp"
#include "integrators/contact_on_the_way.hpp"
#include "integrators/error_account.hpp"
#include "integrators/rounding_level.hpp"

namespace butee::integrators {

/// Step size control by the local error of every component, such that the errors of a whole run add
/// up to the tolerance.
///
///     epsilon = max_i |e_i|/S_i        i over displacements, rotations and their velocities
///     smooth steps:    kappa epsilon^((p+1)/q) <= c tolerance h/T
///     changes of contact:    epsilon_c = k epsilon <= half of the balance of the error account
///
/// S_i is the largest |x_i| (|v_i|) so far, at least a thousandth of the largest of its kind. T is
/// the length of the run. If the estimate e of a method of order p falls with h^q, the local error
/// is kappa epsilon^((p+1)/q). The smooth steps of a run then contribute at most c times the
/// tolerance, times the growth of disturbances. A step in which a stop closes or opens does not
/// follow that power; its error is charged to an account that grows by c tolerance h/T per step.
/// Methods that need a factorization per step size take steps from a geometric grid.
/// integrators/error-control.md has the derivation and the measured constants;
/// tests/conformance/error_constant_test.cpp measures kappa again.
///
/// For structures of more than kLargest DOFs the error of the whole is measured,
///
///     epsilon = max(|e_x|_M/largest |x|_M so far, |e_v|_M/largest |v|_M so far),    |y|_M^2 = y^T M y
///
/// and every step keeps epsilon <= share tolerance^(q/p) for any length of the run. A fine mesh has waves
/// that no output shows, whose rotations a control of every component would resolve. A step that
/// misses contact with a stop is repeated with half its length (ContactOnTheWay). The memory
/// (previous r, account, scales) is the first part of State::memory. Sources: K. Gustafsson, ACM
/// TOMS 17 (1991) 533-554, doi 10.1145/210232.210242; E. Hairer, S. P. Norsett and G. Wanner,
/// Solving Ordinary Differential Equations I, II.4.
class LocalErrorControl {
 public:
  struct Orders {
    double estimate;        ///< q
    double method;          ///< p
    double constant;        ///< kappa, of undamped oscillation
    double contact_change;  ///< k: ratio of local error to estimate across a change of contact
    /// The largest velocity error of a step h = 1 under a force (s - a)_+ per unit of mass, for any a: that of a stop
    /// which closes or opens. 0: not known.
    double kink = 0.0;
    /// The linear part is exact: steps may be longer than the periods of the motion.
    bool is_linear_part_exact = false;
    /// For an explicit method, the stability limit of h omega with closed stops: a longer step in
    /// which a stop closes or opens is repeated even if its estimate is small enough.
    double stability = std::numeric_limits<double>::infinity();
    /// For an explicit method, the largest product of a step and the highest rate at which damping decelerates a DOF.
    /// Damped motion grows in longer steps, and the estimate vanishes at some of them.
    double damping = std::numeric_limits<double>::infinity();
    /// For an explicit method, the largest products of a step with the highest frequency of undamped motion, and with
    /// the fastest decay of damped motion, at which motion does not grow.
    double stable_turn = std::numeric_limits<double>::infinity();
    double stable_decay = std::numeric_limits<double>::infinity();
    /// For structures measured as a whole: the fraction of tolerance^(q/p) that the estimate may
    /// reach.
    double share = 1.0;
    /// Outputs are those of QuinticInterpolant.
    bool has_quintic_outputs = false;
  };
  /// `geometric`: step sizes lie on a geometric grid of ratio 2^(1/4), so that factorizations are
  /// reused.
  enum class Steps { any, geometric };
  /// `dynamics` must outlive it.
  LocalErrorControl(dynamics::Dynamics& dynamics, const Goal& goal, Orders orders, Steps steps);

  const time::StepController& controller() const { return controller_; }
  /// A first step that is short compared with 1/omega of the stiffest DOF and of the fastest harmonic load, s.
  double first_step() const { return first_step_; }

  /// The largest number of DOFs for which every component has its own scale.
  static constexpr Index kLargest = 600;
  /// Entries of State::memory for n DOFs.
  static Index memory_size(Index n) { return kScales + 2 * n; }
  /// Fills the memory of the initial state, which has at least memory_size() entries.
  void start(time::State& state);
  /// Judges a step by the error estimates e_x and e_v. `to` holds its own acceleration or that of
  /// `from`. Fills error and proposal of the report, and the memory of `to`.
  void judge(const time::State& from, time::State& to, double h, ConstVectorRef error_x, ConstVectorRef error_v,
             time::StepReport& report);
  /// Begins a step and looks at one of its stages; for explicit methods, whose stages may meet a stop that is on the
  /// same side at both ends.
  void begin(const time::State& from) { contact_.begin(from); }
  void look(ConstVectorRef x) { contact_.look(x); }

  /// True if the fastest motion passes more than kStiff rad in a step of this length and errors are measured as a
  /// whole, so that it need not be resolved.
  bool is_long(double h) const { return as_a_whole_ && h * rate_ > kStiff; }
  /// True if nothing has moved up to this state but by rounding.
  bool is_still(const time::State& state);
  /// A structure rests, for example in a static position, as long as its velocities are below kStill times the highest
  /// rate and the displacements: they are rounding.
  static constexpr double kStill = 1e-10;

  /// The largest |x|_M and |v|_M so far.
  static double norm_x(const time::State& state) { return state.memory[kNormX]; }
  static double norm_v(const time::State& state) { return state.memory[kNormV]; }
  /// The scales of displacements and velocities in the memory of a state.
  static auto scales_x(const time::State& state) { return state.memory.segment(kScales, state.x.size()); }
  static auto scales_v(const time::State& state) {
    return state.memory.segment(kScales + state.x.size(), state.x.size());
  }

  /// Traits::velocity_uncertainty; chosen: the force of a dashpot at that rate is a tenth of the tolerance.
  double velocity_uncertainty() const { return 0.1 * tolerance_; }

  /// A step in which the fastest motion passes more than this phase angle, rad, is stiff: the error of the solution
  /// falls no faster than the estimate there (order reduction).
  static constexpr double kStiff = 6.0;
  /// The smallest tolerance of methods of order 2; below it they need too many steps to be useful.
  static constexpr double kSecondOrder = 1e-6;
  static constexpr double kLargestTolerance = 0.1;
  /// The tolerance parameter of all methods with this control. Tolerances below `smallest` are
  /// refused.
  static config::Parameter parameter(double fallback, double smallest);

 private:
  class Proposed final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override {
      return {report.error <= 1.0, report.proposal};
    }
  };
  /// Indices in the memory.
  static constexpr Index kOld = 0, kAccount = 1, kNormX = 2, kNormV = 3, kScales = 4;

  /// True if a contact with a nonlinear law begins or ends at an end of the step. There its force
  /// varies with a fractional power of time, but the estimate assumes a smooth function.
  bool touches_anew(const time::State& from, const time::State& to) const;
  /// True if a contact passes the inner border of its law in the step, where the estimate assumes a smooth function
  /// too.
  bool passes_inner_border(const time::State& from, const time::State& to) const;
  /// ContactOnTheWay::longest_of_impact() for all contacts.
  double longest_of_impact(const time::State& from, double h, const Vector& scale_v);
  /// True if the slip of a contact with smooth friction reverses within a small part of the step, so that the friction
  /// jumps in it.
  bool slip_reverses(const time::State& from, const time::State& to) const;
  /// A change of contact within a step, and its least charge to the account, whatever the estimate.
  struct Change {
    bool has_changed = false;
    double least = 0.0;
  };
  Change change_of_contact(const time::State& from, const time::State& to, double h);
  /// The error of a step over the one it may have, for an estimate epsilon, and the charge to the account.
  double error_ratio(const time::State& from, const time::State& to, double h, double epsilon, const Change& change,
                     const Vector& scale_x, double& charge);
  /// The largest error, relative to the scales, of a step of length h without a change of contact.
  double smooth_error(double h) const;
  /// The errors of velocities count also as errors of displacements in outputs within the step.
  static double relative_error(double h, ConstVectorRef error_x, ConstVectorRef error_v, const Vector& scale_x,
                               const Vector& scale_v);
  /// The largest error of a velocity in outputs within the step, whose quintic has the errors of displacements at its
  /// end, relative to kInOutputs tolerances of output_v_ and in terms of an estimate.
  double output_error(ConstVectorRef error_x, const Vector& scale_x) const;
  /// The departure in the middle from the cubic through the ends that the acceleration at the start indicates, relative
  /// to the displacement scales. If it is not small, the step is longer than a motion that begins with it, of which the
  /// estimates of L-stable methods show nothing.
  double unseen_start(const time::State& from, const time::State& to, double h, const Vector& scale_x);
  /// True if is_still() and the errors of the step are rounding, too.
  bool rests(const time::State& to, ConstVectorRef error_x, ConstVectorRef error_v);
  /// The longest step in which no motion grows, s: infinite for implicit methods. Found at the first call.
  double longest_stable();
  double norm(ConstVectorRef y);
  /// The relative error of the whole structure; updates the norms in the memory of `to`.
  double whole_error(const time::State& from, time::State& to, double h, ConstVectorRef error_x, ConstVectorRef error_v,
                     double smooth);
  double any_step(double h, double r, double old, double order) const;
  double grid_step(double h, double r, double order) const;
  /// The step on the grid by this number of indices longer than h, rounded down.
  static double longer_step(double h, double indices);

  const dynamics::Dynamics& dynamics_;
  const dynamics::ElasticStops& stops_;
  dynamics::Obstacles* obstacles_;  ///< null if there are none
  Proposed controller_;
  std::vector<std::pair<Index, double>> inner_borders_, inner_borders_of_obstacles_;  ///< of stops and obstacles, m
  ContactOnTheWay contact_;
  CentreCrossing centre_;
  ErrorAccount account_;
  std::optional<RoundingLevel> rounding_;  ///< none for structures measured as a whole
  Orders orders_;
  double power_;       ///< q/(p + 1)
  double first_step_;  ///< s
  /// The highest frequency of a single DOF with all stops closed, or rate with supports slipping, 1/s; 0 without any
  /// stiffness.
  double omega_ = 0.0;
  double rate_ = 0.0;     ///< that, or the highest rate at which damping decelerates a DOF, 1/s
  double fastest_ = 0.0;  ///< that, the highest frequency of a harmonic load or 1/run_time, 1/s
  double longest_ = std::numeric_limits<double>::infinity();  ///< step by Orders::damping, s
  std::optional<double> longest_stable_;
  Steps steps_;
  ComponentScales scales_;
  std::vector<double> discontinuities_;  ///< instants at which a load or its slope jumps, s
  double whole_;                         ///< bound of epsilon for structures measured as a whole
  double tolerance_;
  double output_time_;  ///< s: displacements over velocities whose errors are as large in outputs; infinite: any
  bool as_a_whole_;
  Vector scale_x_, scale_v_, work_;
  Vector output_v_;             ///< the scales of velocities in outputs; empty unless outputs are quintics
  Vector level_x_, level_v_;    ///< the scales, at least those of rounding
  Vector excess_x_, excess_v_;  ///< errors beyond rounding
};

}  // namespace butee::integrators

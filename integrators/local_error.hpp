#pragma once

#include <limits>

#include "butee/time/integrator.hpp"
#include "integrators/contact_on_the_way.hpp"

namespace butee::integrators {

/// Step control by an estimate of the local error in displacement and velocity, relative to what moves.
///
///     r = max(|e_x|_M/(largest |x|_M so far), |e_v|_M/(largest |v|_M so far))/tolerance^(q/p),   |y|_M^2 = y^T M y
///     h := h max(0.2, min(5, 0.9 r^(-0.7/q) r_old^(0.4/q))),    accepted where r <= 1
///
/// or, where steps cost a factorization, on a ladder that is gone up only with some reserve,
/// for a method of order p whose estimate falls with h^q, so that the error at the end falls with the tolerance. The
/// A step that goes through a stop unseen is redone with half its length (ContactOnTheWay). The
/// norm of the mass matrix weighs displacements and rotations as they move mass. What it remembers (both largest norms,
/// r_old) is the first part of State::memory. Sources: K. Gustafsson, ACM TOMS 17 (1991) 533-554,
/// doi 10.1145/210232.210242; E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, II.4.
class LocalErrorControl {
 public:
  /// Entries of State::memory.
  static constexpr Index kMemory = 3;

  struct Orders {
    double estimate;  ///< q
    double method;    ///< p
    /// The part of the tolerance that a step may use up, less for long steps, whose estimates a kink within them can
    /// pass unseen.
    double share = 1.0;
    /// By how much the estimate of a step in which a stop closes or opens is taken for too small.
    double kink = 1.0;
    /// Of an explicit method, the h omega at which it is stable within a closed stop: a longer step in which one closes
    /// or opens is redone, whatever its estimate says.
    double stability = std::numeric_limits<double>::infinity();
  };
  /// Whether steps are taken from a ladder of ratio 2^(1/4), so that factorizations are found again.
  enum class Steps { any, ladder };

  /// `dynamics` must outlive it.
  LocalErrorControl(solve::Dynamics& dynamics, double tolerance, Orders orders, Steps steps);

  const time::StepController& controller() const { return controller_; }
  /// A step that is short for the stiffest entry of the system, s.
  double first_step() const { return first_step_; }

  /// Fills the memory of a state at the start; it has at least kMemory entries.
  void start(time::State& state);
  /// Judges a step with the errors e_x and e_v; `to` has its acceleration, or that of `from`. Fills error and proposal
  /// of the report, and the memory of `to`.
  void judge(const time::State& from, time::State& to, double h, ConstVectorRef error_x, ConstVectorRef error_v,
             time::StepReport& report);

  /// The parameter that all methods with this control share.
  static config::Parameter parameter(double fallback);

 private:
  class Proposed final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override {
      return {report.error <= 1.0, report.proposal};
    }
  };

  double norm(ConstVectorRef y);
  double relative_error(const time::State& from, const time::State& to, double error_x, double error_v, double scale_x,
                        double scale_v);
  double any_step(double h, double r, double old) const;
  double ladder_step(double h, double r) const;

  const solve::Dynamics& dynamics_;
  Proposed controller_;
  ContactOnTheWay contact_;
  double threshold_, estimate_order_, kink_, stability_, first_step_;
  double omega_ = 0.0;  ///< 0 where nothing has a stiffness
  Steps steps_;
  Vector work_;
};

}  // namespace butee::integrators

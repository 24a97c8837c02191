#pragma once

#include <cmath>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// The penetration, m, at which a law without a force while open passes from its transition to its linear branch, with
/// a jump in a higher derivative; 0 if it does not tell.
double inner_border(const model::ContactLaw& law);

/// Detects changes of contact within a step. The error estimate of a method does not resolve them,
/// since its few stages sample the slope discontinuity of the force once or not at all. Checked in
/// tests/unit/contact_on_the_way_test.cpp.
class ContactOnTheWay {
 public:
  /// Impulses below this fraction of the tolerance times m S_v are ignored.
  static constexpr double kNegligibleImpulse = 0.1;

  /// `dynamics` must outlive it.
  ContactOnTheWay(dynamics::Dynamics& dynamics, double tolerance);

  /// Begins a step of a method that tells its stages.
  void begin(const time::State& from);
  /// Notes the stops that a stage meets on another side than the start of the step: the estimate is then not that of a
  /// smooth force, even if both ends are on the same side.
  void look(ConstVectorRef x);

  /// True if a stop is open at one end of the step, or at a stage, and closed at the other, if the step leads
  /// through or towards the bend of a regularised law without resolving it, or if the force of a stop
  /// with two sides jumped from one side to the other. Such a jump occurs at the middle of the gap
  /// for laws that exert a force there, such as arctan with a lambda of a few gaps. Jumps J and
  /// bends with an asymptotic force J whose impulse within the step, J h, is less than
  /// kNegligibleImpulse times tolerance times m S_v (mass and velocity scale of the DOF) are
  /// ignored.
  bool changed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v);
  /// The largest such jump or asymptotic force in a step of h, as the acceleration of its DOF over that DOF's velocity
  /// scale, 1/s; 0 if there is none. An error estimate misses a jump in the middle of a step, since
  /// the errors of the stages cancel.
  double jump(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v);
  /// The largest rate of change of the force of a stop that closed or opened in the step or at a stage, N/s, as jump(),
  /// 1/s^2. The
  /// estimate vanishes at some places of the change in the step where the error does not.
  double kink(const time::State& from, const time::State& to, ConstVectorRef scale_v);
  /// True if the step that changed() last found free of changes covers more than 0.3 of the distance to the poles of a
  /// regularised law, which are +-i transition widths from its border: the error, a series in powers of h, hardly
  /// converges, so that it is no smaller than the estimate.
  bool is_fast_at_bend() const { return is_fast_at_bend_; }
  /// The largest phase angle, rad, that the contact of a body may turn in the step that begins with it.
  static constexpr double kMostTurn = 3.0;
  /// The longest step, s, from a state in which stops have just closed that resolves how they turn their bodies;
  /// infinite if none has. L-stable methods damp such a motion in one long step, in which their estimate shows little
  /// of it. Speeds below the tolerance times S_v are ignored.
  double longest_of_impact(const time::State& from, double h, ConstVectorRef scale_v);
  /// The depth of a penetration that has just begun, as a fraction of that which its speed reaches in the step.
  static constexpr double kJustClosed = 0.1;

  /// True if a stop is open at both ends of the step and was closed in between, or closed and was
  /// open in between, or passed such a jump and returned, according to the cubic through
  /// displacements and speeds at both ends. Penetrations below the tolerance times displacement or
  /// gap are ignored if their impulse, at most k depth h, is less than kNegligibleImpulse times
  /// tolerance times m S_v; so are openings of any depth.
  bool was_missed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v);

 private:
  /// The force is zero at w = 0 itself, so that a step from or to w = 0 also passes the jump.
  bool has_passed_middle(Index stop) const {
    return jumps_[stop] > 0.0 && w0_[stop] * w1_[stop] <= 0.0 && w0_[stop] != w1_[stop];
  }

  /// A step of h along the force of a regularised law.
  struct Bend {
    /// The change of force, N, that the step does not resolve if it leads through the bend and further than its width,
    /// or on the way from or to the bend; otherwise 0.
    double force = 0.0;
    bool is_fast = false;  ///< is_fast_at_bend() for this stop, whatever its force
  };
  /// A motion that turns is taken as one of constant acceleration.
  Bend bend(Index stop, double h) const;

  /// True if the impulse of a jump (N) of the force of a stop within a step of h exceeds its bound.
  bool is_noticeable(Index stop, double jump, double h, ConstVectorRef scale_v) const;

  dynamics::ElasticStops* contact_;
  double tolerance_;
  /// The largest 1/(m S_v) of the DOFs of a stop: the change of speed by an impulse, over the
  /// velocity scale, 1/(N s).
  double impulse_rate(Index stop, ConstVectorRef scale_v) const;

  Vector mass_;          ///< diagonal of the mass matrix
  Vector closed_;        ///< stiffness of closed stops, N/m
  Vector jumps_;         ///< jump of the force of each stop at the middle of its gap, N
  Vector residual_;      ///< residual force of regularised laws, N
  Vector bends_;         ///< the penetrations up to which the force of a regularised law bends, m; 0: not at all
  Vector least_, most_;  ///< the displacements of stops between which they stay on their side at the start of a step, m
  Vector strayed_;       ///< 1 for those that a stage met beyond, if there are any
  bool has_strayed_ = false, is_fast_at_bend_ = false;
  Vector w0_, w1_, v0_, v1_, a0_;
};

}  // namespace butee::integrators

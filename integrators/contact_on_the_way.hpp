#pragma once

#include <cmath>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// What a step did to the stops, of which an estimate of its error knows little: it sees one kink of the force at a few
/// stages, or none. Checked in tests/unit/contact_on_the_way_test.cpp.
class ContactOnTheWay {
 public:
  /// `dynamics` must outlive it.
  ContactOnTheWay(dynamics::Dynamics& dynamics, double tolerance);

  /// True where a stop is open at one end of the step and closed at the other, or where the force of one with two sides
  /// jumped from one side to the other between them: a law that is blunt against the gap, such as arctan with a lambda
  /// of a few gaps, pulls at the middle already. Jumps whose impulse within the step, J h, is less than
  /// kNegligibleImpulse times the tolerance of m S_v are ignored.
  bool changed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v);
  /// The largest such jump between them, as the acceleration of its DOF over that DOF's velocity scale, 1/s; 0 where
  /// there is none. An estimate does not see a jump in the middle of a step, where the errors of all stages cancel.
  double jump(const time::State& from, const time::State& to, ConstVectorRef scale_v);
  /// True where a stop is open at both ends and was closed on the way, or beyond such a jump, as far as the cubic
  /// through displacements and speeds at both ends can tell. Smaller penetrations than the tolerance times displacement
  /// or gap are ignored if their impulse, at most k depth h, is less than kNegligibleImpulse times the tolerance of m
  /// S_v.
  bool was_missed(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v);

 private:
  /// In the middle itself there is no force.
  bool has_passed_middle(Index stop) const {
    return jumps_[stop] > 0.0 && w0_[stop] * w1_[stop] <= 0.0 && w0_[stop] != w1_[stop];
  }

  /// True where the jump of a stop within a step of h counts.
  bool is_noticeable(Index stop, double h, ConstVectorRef scale_v) const;

  dynamics::Contact* contact_;
  double tolerance_;
  /// The largest k depth/(m S_v) of stop i for a depth of 1, 1/s.
  double impulse_rate(Index stop, ConstVectorRef scale_v) const;

  Vector mass_;    ///< diagonal
  Vector closed_;  ///< stiffness of closed stops, N/m
  Vector jumps_;   ///< N, of each stop at the middle of its gap
  Vector w0_, w1_, v0_, v1_, a0_;
};

}  // namespace butee::integrators

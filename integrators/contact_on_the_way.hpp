#pragma once

#include <cmath>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// What a step did to the stops, of which an estimate of its error knows little: it sees one kink of the force at a few
/// stages, or none. Checked in tests/unit/contact_on_the_way_test.cpp.
class ContactOnTheWay {
 public:
  /// `dynamics` must outlive it.
  ContactOnTheWay(solve::Dynamics& dynamics, double tolerance);

  /// True where a stop is open at one end of the step and closed at the other, or where the force of one with two sides
  /// jumped from one side to the other between them: a law that is blunt against the gap, such as arctan with a lambda
  /// of a few gaps, pulls at the middle already.
  bool changed(const time::State& from, const time::State& to);
  /// The largest such jump between them, as the acceleration sqrt(a.M a) that it makes; 0 where there is none. How
  /// wrong a step becomes by it no estimate tells that has the jump in its middle, where errors of all stages cancel.
  double jump(const time::State& from, const time::State& to);
  /// True where a stop is open at both ends and was closed on the way, or beyond such a jump, as far as the cubic
  /// through displacements and speeds at both ends can tell, by more than the tolerance times its displacement or gap.
  /// Whatever is less is what the tolerance allows for anyway.
  bool was_missed(const time::State& from, const time::State& to, double h);

 private:
  /// A start in the middle itself is on neither side.
  bool has_passed_middle(Index stop) const { return jumps_[stop] > 0.0 && w0_[stop] * w1_[stop] < 0.0; }

  solve::Contact* contact_;
  double tolerance_;
  Vector jumps_;  ///< of each stop at the middle of its gap, where it is more than the tolerance allows for, or 0
  Vector w0_, w1_, v0_, v1_, a0_;
};

}  // namespace butee::integrators

#pragma once

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// What a step did to the stops, of which an estimate of its error knows little: it sees one kink of the force at a few
/// stages, or none. Checked in tests/unit/contact_on_the_way_test.cpp.
class ContactOnTheWay {
 public:
  /// `dynamics` must outlive it.
  explicit ContactOnTheWay(solve::Dynamics& dynamics);

  /// True where a stop is open at one end of the step and closed at the other.
  bool changed(const time::State& from, const time::State& to);
  /// True where a stop is open at both ends and was closed on the way, as the cubic through displacements and speeds at
  /// both ends has it, by more than `tolerance` times its displacement or gap. Whatever is less
  /// is what the tolerance allows for anyway.
  bool was_missed(const time::State& from, const time::State& to, double h, double tolerance);

 private:
  solve::Contact* contact_;
  Vector w0_, w1_, v0_, v1_;
};

}  // namespace butee::integrators

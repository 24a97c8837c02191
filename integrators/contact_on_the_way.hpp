#pragma once

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
  /// True where a stop is open at both ends and was closed on the way, as the cubic through displacements and speeds at
  /// both ends has it, by more than the tolerance times its displacement or gap. Whatever is less
  /// is what the tolerance allows for anyway.
  bool was_missed(const time::State& from, const time::State& to, double h);

 private:
  solve::Contact* contact_;
  double tolerance_;
  std::vector<bool> jumps_;  ///< of each stop: at the middle of the gap, by more than the tolerance allows for
  Vector w0_, w1_, v0_, v1_;
};

}  // namespace butee::integrators

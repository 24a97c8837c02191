#pragma once

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// Looks for stops that a step goes through unseen: open at both of its ends, closed on the way.
///
/// No estimate of an error sees those, since no stage need have met the stop; what an impact does to a velocity is not
/// small all the same. The way of a stop is the cubic through displacements and speeds at both ends. Checked in
/// tests/unit/missed_contact_test.cpp.
class MissedContact {
 public:
  /// `dynamics` must outlive it.
  explicit MissedContact(solve::Dynamics& dynamics);

  /// True where a stop was closed on the way by more than `tolerance` times its displacement or gap. Whatever is less
  /// is what the tolerance allows for anyway.
  bool happened(const time::State& from, const time::State& to, double h, double tolerance);

 private:
  solve::Contact* contact_;
  Vector w0_, w1_, v0_, v1_;
};

}  // namespace butee::integrators

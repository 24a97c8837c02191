#pragma once

#include <vector>

#include "butee/dynamics/centre_pulls.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/time/state.hpp"

namespace butee::integrators {

/// Detects steps through the centre of a ring whose law pulls while apart, such as `arctan`. Near the centre the pull
/// changes its direction within a part of the step, at most to the opposite one, which the few stages of a method do
/// not resolve and their error estimate does not show. Checked in tests/verification/ring_test.cpp.
class CentreCrossing {
 public:
  /// `dynamics` must outlive it.
  explicit CentreCrossing(dynamics::Dynamics& dynamics);

  /// The largest change of the pull in a step of h, as the acceleration of its DOF over that DOF's velocity scale, 1/s;
  /// 0 if no body passes a centre at a distance below its way in the step.
  double jump(const time::State& from, const time::State& to, double h, ConstVectorRef scale_v) const;

 private:
  /// The largest F/(m S_v) of the DOFs of a contact, 1/s, for a force along its directions, N.
  double rate_of(Index contact, const Eigen::Vector2d& force, ConstVectorRef scale_v) const;

  const dynamics::Obstacles* obstacles_;
  Vector mass_;  ///< diagonal of the mass matrix
  std::vector<dynamics::CentrePull> pulls_;
};

}  // namespace butee::integrators

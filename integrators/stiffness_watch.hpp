#pragma once

#include "butee/core/types.hpp"

namespace butee::integrators {

/// Notices that stability and not accuracy limits the steps of an explicit method, and says so once.
///
/// The accelerations of two stages at nearly the same place tell the highest frequency that moves, omega^2 =
/// |a(y) - a(z)|/|y - z|; where h omega is near the method's limit for fifteen steps the scene is stiff for it. Source:
/// E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, section IV.2.
class StiffnessWatch {
 public:
  /// `limit`: of h omega.
  explicit StiffnessWatch(const char* method, double limit) : method_(method), limit_(limit) {}

  /// |a(y) - a(z)| and |y - z| of a step of length h that was accepted at `t`.
  void look(double t, double h, double accelerations, double displacements);

 private:
  const char* method_;
  double limit_;
  int near_ = 0;
  bool has_warned_ = false;
};

}  // namespace butee::integrators

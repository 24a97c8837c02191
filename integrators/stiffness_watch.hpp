#pragma once

#include "butee/core/types.hpp"

namespace butee::integrators {

/// Detects that stability instead of accuracy limits the steps of an explicit method, and logs a
/// warning once.
///
/// The accelerations of two stages at nearly the same displacements estimate the highest frequency
/// in the motion, omega^2 = |a(y) - a(z)|/|y - z|. If h omega is near the limit of the method for
/// fifteen steps in a row, the scene is stiff for it. Source: E. Hairer and G. Wanner, Solving
/// Ordinary Differential Equations II, section IV.2.
class StiffnessWatch {
 public:
  /// `limit`: stability limit of h omega.
  explicit StiffnessWatch(const char* method, double limit) : method_(method), limit_(limit) {}

  /// Takes |a(y) - a(z)| and |y - z| of a step of length h that was accepted at `t`.
  void look(double t, double h, double accelerations, double displacements);

 private:
  const char* method_;
  double limit_;
  int near_ = 0;
  bool has_warned_ = false;
};

}  // namespace butee::integrators

#pragma once

#include "butee/dynamics/contact.hpp"

namespace butee::integrators {

/// What an open stop with a regularised law pulls, which away from its gap is nearly constant but for its sign.
class FarPull {
 public:
  FarPull(const dynamics::Contact& contact, Index stop);

  double largest() const { return pull_; }  ///< N
  /// A bound for the displacement that comes of taking the force within a path from w0 to w1, of at most `reach`, for a
  /// constant on either side of the middle of the gap. `mobility` is the displacement in the step by a force of 1 N;
  /// over the motion's own time, of `steps` such steps, what departs in the same sense all the time adds up with their
  /// square, and a jump that comes too early or too late with their number.
  double unfelt(double w0, double w1, double reach, double mobility, double steps) const;

 private:
  double pull_, bend_, gap_;
  bool jumps_;  ///< in the middle of the gap, to the other side
};

/// What that may be, in parts of what outputs may be wrong by.
inline constexpr double kUnfeltPull = 0.02;

/// The displacement up to which an open stop exerts hardly more than a constant pull, m: nearer to its gap than some
/// widths of the bend of its law the force changes. A law so blunt that its bend is a part of the gap has no such
/// place: a hundredth of the gap's width, and what its pull changes by is no less than the springs of the structure.
double calm_border(const dynamics::Contact& contact, Index stop);

}  // namespace butee::integrators

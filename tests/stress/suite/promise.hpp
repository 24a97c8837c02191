#pragma once

#include <vector>

#include "trajectory.hpp"

namespace butee::stress {

/// The result of a comparison with the promised error bound.
struct Judgement {
  double error = 0.0;    ///< the largest e up to the trust horizon
  double allowed = 0.0;  ///< at the instant of the largest ratio of e to its bound
  double excess = 0.0;   ///< e/allowed there
  Index row = 0, component = 0;
  bool in_velocity = false;
};

/// The error bound promised by methods with error control (butee help methods), checked on a trajectory.
///
/// Component i is a displacement, a rotation or the velocity of one of them. Its scale S_i(t) is its largest
/// value so far, but at least a thousandth of the largest value of its kind over the run. e(t) = max
/// |error_i|/S_i. Gamma(t) is the largest e/tolerance of disturbed references until t. The bound is e <= 10
/// tolerance max(1, Gamma) at every instant, times `allowance` in very long runs. The comparison ends at the
/// trust horizon, where the bound exceeds 0.1.
///
/// Velocities at an instant may be compared with a band: the range of the reference's velocities within some
/// time.
class Promise {
 public:
  static constexpr double kPromise = 10.0, kFloor = 1e-3, kHorizon = 0.1;

  /// `largest`: the largest |x| (and |v|) of each component until each instant, including motion between the
  /// instants. `is_rotation` has an entry for each DOF.
  Promise(Trajectory reference, const Trajectory& largest, const std::vector<bool>& is_rotation, double tolerance,
          double allowance = 1.0);

  const Trajectory& scales() const { return scales_; }
  const Trajectory& reference() const { return reference_; }
  double tolerance() const { return tolerance_; }

  /// Velocities at `row` count as correct between `low` and `high`.
  void set_band(Index row, ConstVectorRef low, ConstVectorRef high);
  void clear_bands();

  /// e at a row: for displacements and rotations, and for all components.
  double error_in_place(const Trajectory& of, Index row) const;
  double error(const Trajectory& of, Index row) const;

  /// Raises Gamma by a reference that was disturbed by e = `size` at row `from`; Gamma is the largest value
  /// until each row. If the disturbed run is not complete, its growth counts as unbounded after its last row.
  void raise_growth(const Trajectory& disturbed, Index from, double size, bool is_over, bool with_velocities);
  void clear_growth() { growth_.setZero(); }
  double growth(Index row) const { return growth_[row]; }
  double allowed(Index row) const;
  /// Rows before the trust horizon, and before `limit_rows`.
  Index rows() const;
  void limit_rows(Index most) { most_rows_ = std::min(reference_.rows, most); }

  Judgement judge(const Trajectory& of) const;

 private:
  double velocity_error(const Trajectory& of, Index row, Index i) const;

  Trajectory reference_, scales_;
  Eigen::MatrixXd low_, high_;  ///< bands of velocities
  Vector growth_;
  double tolerance_, allowance_;
  Index most_rows_;
};

}  // namespace butee::stress

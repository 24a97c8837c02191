#pragma once

#include <limits>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/taylor_expansion.hpp"

namespace butee::integrators {

/// The motion over one step as Taylor series, one piece from each change of contact or discontinuity of a load to the
/// next. Keeps the pieces of the step that was followed last; outputs of an earlier one follow it again.
class TaylorPath final : public time::Interpolant {
 public:
  /// `series_tolerance` is the size of the last terms of a series relative to the largest.
  TaylorPath(dynamics::Dynamics& dynamics, int order, double series_tolerance);

  /// The length that the first series at a state allows, s; `length` where it is not known.
  double first_length(const time::State& state, double length);
  /// Follows the motion from a state to the end of the step, or over one piece if the step is to be a single one.
  time::StepStatus follow(const time::State& from, const time::Step& step);
  double end() const { return end_t_; }  ///< s
  const TaylorExpansion& last() const { return pieces_[used_ - 1]; }

  time::Interpolation interpolation() const override { return time::Interpolation::other; }
  /// The instants at which one series ends and the next begins, s.
  std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail) override;
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override;
  /// Bounds from the derivatives of the series, term by term.
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) override;

 private:
  /// More changes of contact within one step are no motion of a structure.
  static constexpr std::size_t kMostPieces = 20000;
  /// A piece is shortened a thousandfold this often before the step is given up.
  static constexpr int kMostTrials = 12;

  /// Expands at (t, x_, v_) into pieces_[used_]; shortens its length where it overflows.
  bool expand_piece(double t, double length);
  void place_branches();
  double next_discontinuity(double t) const;
  bool holds(const time::State& from, double t_end) const;
  /// Follows a step again unless it is the last one that was followed.
  void recall(const time::State& from, const time::State& to);
  const TaylorExpansion& piece_at(double t) const;

  dynamics::Dynamics& dynamics_;
  TaylorExpander expander_;
  ContactBranches branches_;
  std::vector<double> discontinuities_;  ///< of the loads
  std::vector<TaylorExpansion> pieces_;
  std::size_t used_ = 0;
  std::vector<double> breakpoints_;
  Vector begin_x_, begin_v_;
  double begin_t_ = 0.0, end_t_ = std::numeric_limits<double>::quiet_NaN();
  Vector x_, v_, stops_;
};

}  // namespace butee::integrators

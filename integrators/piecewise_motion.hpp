#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "butee/time/dense_output.hpp"
#include "integrators/first_change.hpp"

namespace butee::integrators {

/// The motion over one step in closed form, one piece from each change of contact or discontinuity of a load to the
/// next. Keeps the modes of the contact states that occurred, and the pieces of the step that was followed last;
/// outputs of an earlier one follow it again.
class PiecewiseMotion final : public time::Interpolant {
 public:
  /// `end_time`, s. Throws InputError where the scene is of another kind or a contact state has no modes.
  PiecewiseMotion(dynamics::Dynamics& dynamics, double end_time);

  /// The statuses of the stops, and the stop that changed last (-1: none), at a state.
  void write_status(const time::State& at, VectorRef memory) const;
  Index memory_size() const { return system_.stop_count() + 2; }

  /// Follows the motion from a state to the end of the step, kMostPieces pieces or a turn of kMostTurn.
  void follow(const time::State& from, const time::Step& step);
  /// The end of what follow() followed, s, its motion and status there.
  void write_end(time::State& to) const;
  int piece_count() const { return static_cast<int>(begins_.size()); }
  /// Forgets the pieces.
  void clear() { end_t_ = std::numeric_limits<double>::quiet_NaN(); }

  time::Interpolation interpolation() const override { return time::Interpolation::other; }
  /// Changes of contact, discontinuities of loads, and instants in between that limit the phase
  /// angle of the motion from one to the next.
  std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail) override;
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override;
  void interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                       std::span<const Index> dofs, time::Interpolated out) override;
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) override;

  /// Piecewise::derivative() and derivative_by_loads()
  Eigen::MatrixXd derivative(const time::State& from, const time::State& to);
  Vector derivative_by_loads(const time::State& from, const time::State& to);

 private:
  /// So many states are kept; the one not used for the longest time goes.
  static constexpr std::size_t kMostStates = 128;
  struct State {
    std::vector<bool> closed;
    std::unique_ptr<ContactStateFlow> flow;
    std::int64_t used = 0;
  };

  /// The flow of status_.
  const ContactStateFlow& flow();
  /// Begins a piece at (t, x_, v_).
  void begin_piece(double t);
  void load_piece(std::size_t piece);
  /// Follows a step again unless it is the last one that was followed.
  void recall(const time::State& from, const time::State& to);
  /// Goes to t, within the step that is recalled.
  void go_to(double t);
  /// The motion of a DOF there.
  Jet motion_of(Index dof) const { return flow_->dof(piece_, dof); }
  void find_breakpoints();
  /// Calls jump(stop, sign) for every stop whose dissipation sets in (+1) or ends (-1) with a jump of its force at the
  /// start of a piece of the step that is recalled, and propagate() after the piece was loaded.
  template <class Jump, class Propagate>
  void follow_pieces(const time::State& from, const time::State& to, Jump jump, Propagate propagate);
  /// The jump of v by x, M^-1 r^T c, of a stop with w = r x, n.
  Vector jump_of(Index stop) const;
  double next_discontinuity(double t) const;

  linalg::Counters& counters_;
  SmallSystem system_;
  FirstChange first_change_;
  double end_time_;
  std::vector<double> discontinuities_;  ///< of the loads
  std::vector<State> states_;
  std::size_t current_ = 0;
  std::int64_t uses_ = 0;
  ContactStateFlow::Piece piece_;
  const ContactStateFlow* flow_ = nullptr;  ///< of piece_
  static constexpr auto kNoPiece = static_cast<std::size_t>(-1);
  std::size_t loaded_ = kNoPiece;
  std::vector<StopStatus> status_;
  FirstChange::Changed changed_;  ///< the stop that changed at the end of the last piece
  std::vector<bool> closed_;
  std::vector<double> x_, v_;
  Eigen::MatrixXd force_;

  // The pieces of the last step, kept for its outputs: instants, motions and statuses at their starts.
  std::vector<double> begins_, begin_x_, begin_v_;
  std::vector<StopStatus> begin_status_;
  double end_t_ = std::numeric_limits<double>::quiet_NaN();
  Vector from_x_, from_v_, from_memory_;
  std::vector<double> breakpoints_;
  bool has_breakpoints_ = false, has_dashpots_ = false;
};

}  // namespace butee::integrators

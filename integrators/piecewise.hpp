#pragma once

#include <memory>
#include <string>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/first_change.hpp"

namespace butee::integrators {

/// piecewise: the motion in closed form from one change of contact to the next, every change located.
///
/// For few DOFs and stops with the linear law, elastic or with Kelvin-Voigt dissipation. Between two changes the system
/// is linear: x(t) follows from the modes of the contact state, which are made when the state first occurs and kept.
/// There is no truncation error and no step; cost is a few evaluations a change of contact. Errors are rounding times
/// the growth of disturbances. Theory: piecewise.md. Checked in tests/models/piecewise_test.cpp.
class Piecewise final : public time::Integrator {
 public:
  /// `end_time`, s. Throws InputError, which names methods that can, where the scene is of another kind.
  Piecewise(dynamics::Dynamics& dynamics, double end_time);

  bool handles_load_discontinuities() const override { return true; }
  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State&) const override { return std::numeric_limits<double>::infinity(); }
  /// Where contacts change, loads have discontinuities, and instants so near to each other that the motion turns little
  /// between.
  std::span<const double> breakpoints(const time::State& from, const time::State& to) const override;
  time::DenseOutput dense_output() const override { return time::DenseOutput::other; }
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) const override;

  /// The derivative of (x, v) at the end of an accepted step with respect to (x, v) at its start, 2n x 2n: the product
  /// of those of its pieces, and of what a stop with dissipation adds where its force jumps. At grazing contact, where
  /// it does not exist, that of the pieces taken. Over several steps: the product.
  Eigen::MatrixXd derivative(const time::State& from, const time::State& to) const;
  /// The derivative of (x, v) at the end with respect to a factor on all loads, at 1, in this step alone, 2n. Over
  /// several steps: s := derivative() s + this.
  Vector derivative_by_loads(const time::State& from, const time::State& to) const;

  /// Contact states whose modes were computed, those given up included.
  std::int64_t states_made() const { return states_made_; }

 private:
  /// Every step stands; the next goes to the end.
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport&) const override {
      return {true, std::numeric_limits<double>::infinity()};
    }
  };
  /// So many states are kept; the one not used for the longest time goes.
  static constexpr std::size_t kMostStates = 128;
  struct State {
    std::vector<bool> closed;
    std::unique_ptr<ContactStateFlow> flow;
    std::int64_t used = 0;
  };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  void do_interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                      time::Interpolated out) const override;
  void do_interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                          std::span<const Index> dofs, time::Interpolated out) const override;

  /// Follows the motion to the end of the step, or where so many pieces are full; the state there is in x_ and v_.
  void follow(const time::State& from, const time::Step& step);
  /// The flow of status_.
  const ContactStateFlow& flow();
  /// Begins a piece at (t, x_, v_).
  const ContactStateFlow& begin_piece(double t);
  void recall(const time::State& from, const time::State& to);
  /// Takes piece_ to t, within the step that is recalled.
  void take_to(double t);
  void load_piece(std::size_t piece);
  void find_knots();
  /// Calls jump(stop, sign) for every stop whose dissipation sets in (+1) or ends (-1) with a jump of its force at the
  /// start of a piece of the step that is recalled, and propagate() after the piece was loaded.
  template <class Jump, class Propagate>
  void follow_pieces(const time::State& from, const time::State& to, Jump jump, Propagate propagate);
  /// The jump of v by x, M^-1 r^T c, of a stop with w = r x, n.
  Vector jump_of(Index stop) const;
  double next_discontinuity(double t) const;

  Controller controller_;
  SmallSystem system_;
  FirstChange first_change_;
  double end_time_;
  std::vector<double> discontinuities_;  ///< of the loads
  std::vector<State> states_;
  std::size_t current_ = 0;
  std::int64_t uses_ = 0, states_made_ = 0;
  ContactStateFlow::Piece piece_;
  const ContactStateFlow* flow_ = nullptr;  ///< of piece_
  std::size_t loaded_ = static_cast<std::size_t>(-1);
  std::vector<StopStatus> status_;
  Index changed_ = -1;  ///< the stop that changed at the end of the last piece
  std::vector<bool> closed_;
  std::vector<double> x_, v_;
  Eigen::MatrixXd force_;

  // The pieces of the last step, kept for its outputs: instants, motions and statuses at their starts.
  std::vector<double> begins_, begin_x_, begin_v_;
  std::vector<StopStatus> begin_status_;
  double end_t_ = -1.0;
  Vector from_memory_;
  std::vector<double> knots_;
  bool has_knots_ = false;
};

}  // namespace butee::integrators

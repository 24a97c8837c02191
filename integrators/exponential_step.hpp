#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "butee/dynamics/modal_system.hpp"
#include "integrators/far_pull.hpp"
#include "integrators/modal_energy.hpp"
#include "integrators/modal_knots.hpp"
#include "integrators/stop_path.hpp"

namespace butee::integrators {

/// What became of an attempt at a step.
enum class Trial { accepted, too_long, not_finite };

/// A step that would do with less than this part of its tolerance is followed by one a rung longer, whose error is four
/// times that; the rest is reserve against going back and forth.
inline constexpr double kEasy = 0.1;
/// The iteration for the forces ends where the paths change by less than this part of the tolerance, or by rounding.
inline constexpr double kConverged = 0.02;
inline constexpr double kRounding = 1e-15;
/// Or where the next sweep would change them, if it contracts as the last did, by less than this part of that.
inline constexpr double kExpected = 0.1;
/// The speed of a stop counts with this part of stiffness times displacement at least, so that a stop at rest may
/// converge.
inline constexpr double kLeastPart = 1e-4;
/// After the first sweep a stop whose path others have changed by less than this part of the tolerance keeps its force.
inline constexpr double kSettled = 0.2;
/// Sweeps; where they do not suffice the step is too long for the stiffness of the stops.
inline constexpr int kMostSweeps = 25;
/// The bump functions of cubic Hermite interpolation are at most 4/27.
inline constexpr double kBump = 4.0 / 27.0;

/// Error bounds of a step.
struct StepGoal {
  double middle;     ///< the displacement in the middle of a step that the cubic through its ends does not explain,
                     ///< relative to the largest displacement of a stop so far
  double outputs;    ///< what outputs within a step are wrong by, relative to that
  double tolerance;  ///< of the run
  double run_time;   ///< s
};

/// The largest displacement and speed of a stop so far, which errors are relative to.
struct StopScale {
  double displacement = 0.0, speed = 0.0;

  /// s; infinite at rest
  double own_time() const { return speed > 0.0 ? displacement / speed : std::numeric_limits<double>::infinity(); }
};

/// The scale of a stop is at least this part of the largest one: the floor of the promise (error-control.md).
inline constexpr double kScaleFloor = 1e-3;
/// m, where nothing moves
inline constexpr double kTiny = 1e-300;

/// The motion's own time, in steps of h.
inline double steps_of(StopScale scale, double h) {
  if (scale.speed == 0.0) return 1.0;  // Nothing moves.
  return h * scale.speed < scale.displacement ? scale.displacement / (h * scale.speed) : 1.0;
}

/// The path of a stop is wrong by this part of its bulge, whose own place in it is known.
inline constexpr double kPathError = 0.1;

/// The part of the error of a run that may come of pulls that are wrong in the same sense all the time, 1/s in
/// tolerances: the force of a stop may be wrong by this part of what would change its speed by the tolerance in a run.
inline constexpr double kLasting = 0.4;
/// Share of a run's error bound for residual forces that one characteristic time of the motion, `steps` h, may use.
inline double share_of_run(double h, double steps, double run_time) {
  constexpr double kTimes = 10.0;
  return std::min(1.0, kTimes * h * steps / run_time);
}

/// The part of the departure from the cubic, times (h omega_c)^4, that its force may get wrong in the speed after a
/// step, times h. That of a whole impact within a step counts so much more than its small displacements: without it the
/// speed after impacts at stops of 1e12 N/m came out wrong by percents at a tolerance of 1e-4. More of it counts while
/// a stop stays closed, where a mass that is pressed against it turns many times before it leaves with what is left.
inline constexpr double kOfSpeed = 0.1, kOfSpeedClosed = 0.5;

/// The error of a stop's path in a step of h, as one of displacement: that of the speed after it counts as much,
/// relative to the largest speed. `bulge` is the departure, `stiff` = (h omega_c)^2 of the stop alone.
inline double error_of_path(double bulge, double stiff, double h, StopScale scale, bool stays_closed) {
  const double speed = h * scale.speed;
  const double of_speed = (stays_closed ? kOfSpeedClosed : kOfSpeed) * stiff * stiff;
  return bulge * (of_speed * scale.displacement > speed ? of_speed * scale.displacement / speed : 1.0);
}

/// The change of a stop's path, m, whose displacement and whose change of speed, times h, by the stop's force are
/// within the tolerance.
inline double allowed_change(double tolerance, double stiff, double h, StopScale scale) {
  const double of_displacement = std::abs(stiff) * scale.displacement;
  const double of_speed = std::max(h * scale.speed, kLeastPart * of_displacement);
  return tolerance * (of_displacement > of_speed ? of_speed / std::abs(stiff) : scale.displacement);
}

/// Between the ends of a step that no force of a stop bends, outputs lie on a quintic. Its error is that of the cubic,
/// (omega h)^4/384 of the amplitude, times (omega h)^2/120.
inline constexpr double kQuintic = 1.0 / 120.0;
/// Rungs to go up after a step without contact whose quintic is wrong by this part of what it may be, an error that
/// grows by eight a rung.
inline int rungs_up(double part) {
  constexpr double kAim = 0.4, kMost = 8.0;
  if (part <= 0.0) return static_cast<int>(kMost);
  return static_cast<int>(std::clamp(std::floor(std::log2(kAim / part) / 3.0), 0.0, kMost));
}
/// The quintic misses an odd motion about its middle in the speed alone: 16 s^2 (1 - s)^2 (2 s - 1), whose slope there
/// is -2, is at most 0.29.
inline constexpr double kOddPart = 0.15;
/// The longest step near a stop, s: the slowest mode and the loads turn by kMostTurn at most. In longer ones a few
/// values of the path say nothing about where it was between.
inline double longest_near_stops(const dynamics::ModalSystem& modal) {
  constexpr double kMostTurn = 1.5;
  double fastest = modal.frequencies().minCoeff();
  for (const dynamics::ModalHarmonic& harmonic : modal.harmonics())
    fastest = std::max(fastest, harmonic.angular_frequency);
  return fastest > 0.0 ? kMostTurn / fastest : std::numeric_limits<double>::infinity();
}
/// With a knot in the middle of the step quintics are wrong by 1/64, or by 1/4 where modes turn too fast for any
/// quintic.
inline constexpr double kHalved = 10.0;

/// The largest |int_0^1 (F - P F) e^(i x s) ds| of a force F that rises by 1 a step from somewhere within it on, with
/// its projection P F onto P_0, P_1 and P_2, for a mode that turns by x in the step: what such a mode does not learn of
/// a stop that closes or opens. Bounds of the integral, taken numerically over all places.
inline double unresolved_part(double x) {
  return std::min({7.5e-5 * x * x * x, 0.0172, 0.174 / x});
}
/// That, of all modes, may be so many times what outputs may be wrong by, in the speed of a stop.
inline constexpr double kUnresolved = 1.0;

/// The steps of the method `exponential` within a block: the flow of the modes, and the forces and paths of the stops
/// within reach, found together by sweeps.
class ExponentialStep {
 public:
  /// `order` 2, 4 or 6. Blocks are of up to `most` steps.
  ExponentialStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, int order, const StepGoal& goal,
                  std::size_t most);

  /// A state holds q, v, displacements and speeds of the stops, and the largest so far of each, and of the two bodies
  /// of stops between two. complete() fills in all
  /// after q and v.
  Index memory_size() const {
    return 2 * modal_.size() + 4 * modal_.stop_count() + 4 * static_cast<Index>(pairs_.size());
  }
  void complete(double* memory) const;
  /// Begins a block with the state at t.
  void begin(double t, const double* memory, StopScale scale);
  void save(double* memory) const;
  /// Tries a step of the ladder, or one until t; accept() takes it, to end at t.
  Trial attempt_rung(int level) {
    return attempt(modal_.ladder(level), knots_.last() + dynamics::ModalSystem::ladder_step(level));
  }
  Trial attempt_until(double t);
  /// Raises the scales to what the stops would move by in a step of the ladder without their forces.
  void expect_motion(int level);
  void accept(double t);

  double t() const { return knots_.last(); }
  const double* q() const { return q_.data(); }
  const double* v() const { return v_.data(); }
  StopScale scale() const { return scale_; }
  /// No stop came near its gap in the last attempt.
  bool is_quiet() const { return !is_near_; }
  /// When the first stop is reached at the speeds of now, s from now on; infinite where none is approached.
  double time_to_stop() const;
  /// The rungs by which such a step might be longer, for its quintic.
  int spare_rungs() const { return rungs_up(unsmooth_); }
  /// The error of the last attempt over what it might have been; 0 where none was found.
  double error_ratio() const { return error_ / (tolerance_ * scale_.displacement); }
  /// It would do with a longer step.
  bool is_easy() const { return error_ < kEasy * tolerance_ * scale_.displacement; }
  bool has_stops() const { return !stops_.empty(); }

  /// The instants between the steps of the block.
  std::span<const double> knots() const { return knots_.inner(); }
  /// The motion within the block, of which the state stays what it is.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);
  /// time::Integrator::energies() of the block; not without stops, where its steps are of any length.
  std::span<const time::EnergyAt> energies(std::span<const double> instants);
  /// Without stops: time::Integrator::departure().
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out);

 private:
  /// A stop between two bodies. Its forces move body b by the part share_b of what they move the stop by.
  struct Pair {
    Index stop;
    Vector shape_a;
    double share_a, share_b;
  };
  /// The largest so far of a pair: displacements and speeds of both bodies.
  struct PairScale {
    double x_a = 0.0, x_b = 0.0, v_a = 0.0, v_b = 0.0;
  };
  /// To what moves now.
  void raise_pairs();

  /// Bounds of q and its first six derivatives, mode by mode, from one knot to the next.
  struct ModalBounds {
    std::size_t knot = static_cast<std::size_t>(-1);
    std::array<Eigen::ArrayXd, 7> of;
  };
  void find_bounds_from(std::size_t knot);

  Trial attempt(dynamics::StepFlow& flow, double t_end);
  /// From a knot to t_end; `v` only where it is given.
  void propagate(const dynamics::ModalFlow& flow, std::size_t knot, double t_end, Eigen::ArrayXd& q, Eigen::ArrayXd* v);
  void find_stops();
  void find_reachable(dynamics::StepFlow& flow);
  void find_reach(double h);
  /// Moves stops that the pull brought near their gaps from far_ to reachable_; false if there is none.
  bool add_reachable(dynamics::StepFlow& flow);
  /// Whether a stop may come so near its gap that its force changes.
  bool is_near(Index stop) const { return reach_[stop] > borders_[stop]; }
  /// Whether the pull of an open stop is a constant, as far as the tolerance can tell.
  bool is_steady(dynamics::StepFlow& flow, Index stop) const;
  /// Error bound of residual forces over one characteristic time of the motion, m.
  double felt(double h) const {
    const double steps = steps_of(reached_, h);
    return kUnfeltPull * output_tolerance_ * reached_.displacement * share_of_run(h, steps, goal_.run_time);
  }
  /// Fills shares_.
  void find_shares() {
    shares_ = (largest_w_.max(w_new_.abs()) / std::max(reached_.displacement, kTiny)).max(kScaleFloor);
  }
  /// Fills is_steady_, by FarPull::unfelt() for stops that stay on a side, and largest_shift_.
  void find_steady(dynamics::StepFlow& flow);
  /// What follows for a stop from the length of the step alone.
  const dynamics::StepFlow::Derived& derived(dynamics::StepFlow& flow, Index stop) const;
  /// Whether quintics are enough for outputs within a step without contact: by a bound that takes all modes for in
  /// phase, or else by the exact displacements in the middle, where a knot is laid if one through the ends is not.
  bool is_smooth(const dynamics::StepFlow& flow);
  /// Of the stops, without their forces but for standing pulls.
  void find_accelerations(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v, Eigen::ArrayXd& a);
  /// Sees that pull_ is what stops far from their gaps exert, as far as the tolerance can tell; whether it changed.
  bool place_pull(dynamics::StepFlow& flow);
  /// Whether outputs show the jump of a pull that changes its side, which a knot in the middle of the step, where
  /// forces are divided as the polynomials that they are, would pass over.
  bool shows_jump(double h) const;
  /// Of those that pass the middle of their gap, where their pull changes its side.
  void add_jumps(dynamics::StepFlow& flow);
  /// What the moments of order k of the forces of some stops do.
  void add_moments(const dynamics::StepFlow& flow, const std::vector<Index>& stops, int k);
  /// What the forces in sums_[k] do to the middle of the step, and to a knot there.
  void add_to_half(const dynamics::ModalFlow& half, std::size_t k);
  Trial iterate(dynamics::StepFlow& flow);
  /// Fills near_registers_ and far_registers_.
  void choose_registers();
  /// Fills bulge_ and excess_ for the paths as they are.
  void find_bounds();
  /// Takes the stops in turn, each with the forces of all others as they are; the largest change of a path over
  /// allowed_change(). If `may_skip`, stops whose path moved by less than kSettled of that since their force was found
  /// are passed over.
  double sweep(dynamics::StepFlow& flow, double displacement, bool may_skip);
  /// Error of a stop's path that the displacement and the speed of the stop allow, m.
  double allowed_change(dynamics::StepFlow& flow, Index stop, double displacement) const;
  StopPath path_of(Index stop) const {
    const double bulge =
        path_.middle[stop] - (0.5 * (w_[stop] + path_.end[stop]) + 0.125 * (hv_[stop] - path_.speed[stop]));
    return {w_[stop], hv_[stop], path_.end[stop], path_.speed[stop], orders_ == 3 ? bulge : 0.0};
  }
  /// Whether the stop is a spring along its path.
  bool is_spring(Index stop) const;
  /// Takes the path of a stop for the one that its force was found for.
  void see(Index stop);
  /// By how much the path of a stop is another than when its force was found, and what a stiff stop makes of that in
  /// its speed times h.
  double moved_since(dynamics::StepFlow& flow, Index stop) const;
  /// Takes the forces of the stops that are closed at the start as they would be at constant speed.
  void guess(dynamics::StepFlow& flow);
  /// Adds to the force at a stop, and what that does to all paths; the largest change of a path.
  double add_force(dynamics::StepFlow& flow, Index stop, const ForceMoments& more);
  void find_error(dynamics::StepFlow& flow, double displacement);
  /// Error, relative to the displacement, of a stop that the path passes by if contact would have changed its speed
  /// times h by `push`.
  double error_of_missed(double push, double h, StopScale scale) const {
    return push / (h * scale.speed) * tolerance_ / goal_.tolerance;
  }
  /// Error scales of a stop: its largest displacement and speed so far, at least a thousandth of those of all stops; of
  /// a stop between two bodies those of the body that its force moves most for its scale.
  /// `reached`: in the step tried.
  StopScale scale_of(Index stop, StopScale reached, double displacement) const;
  StopScale reached_on_path(Index stop, double h) const {
    return {std::abs(path_.end[stop]), std::max(std::abs(hv_[stop]), std::abs(path_.speed[stop])) / h};
  }
  /// Of the displacement, by a pull that jumps where the path is said to pass the middle of the gap.
  double error_of_pull(dynamics::StepFlow& flow, Index stop) const;
  /// Whether a stop is in contact at both ends of the step.
  bool stays_closed(Index stop) const;
  void apply_forces(dynamics::StepFlow& flow);
  /// Keeps the forces of the step from a knot, which may be parted by a knot in its middle.
  void record_forces(std::size_t knot);

  dynamics::ModalSystem& modal_;
  std::size_t orders_;  ///< polynomials that the force is projected onto
  StepGoal goal_;
  double tolerance_, output_tolerance_;
  std::vector<StopForce> stops_;
  std::vector<OwnForce> own_;
  std::vector<FarPull> pulls_;
  bool has_far_forces_ = false;
  dynamics::Contact& contact_;
  Vector pull_;              ///< of stops far from their gaps, taken for constant from step to step, N; of others 0
  Eigen::ArrayXd pull_sum_;  ///< the same as modal forces, a part of the flow
  Vector stop_forces_;
  Eigen::ArrayXd squares_;   ///< omega^2
  bool is_strongly_damped_;  ///< a mode decays so fast that bounds by omega know too little
  ModalKnots knots_;
  ModalEnergy energy_;
  ModalBounds modal_bounds_;

  Eigen::ArrayXd q_, v_;
  StopScale scale_;
  StopScale reached_;  ///< the scale, with the end of the step without forces and the speed by a pull
  Eigen::ArrayXd q_new_, v_new_, q_half_, v_half_;
  double middle_knot_ = 0.0;                        ///< its time; 0: there is none
  std::array<Eigen::ArrayXd, 3> sums_, jump_sums_;  ///< modal: of contact, and of pulls that change their side

  // An entry a stop, padded to whole registers.
  Eigen::ArrayXd gaps_, upper_, lower_;   ///< where it acts; infinite where it does not
  Eigen::ArrayXd off_upper_, off_lower_;  ///< 0 where it acts on that side, else further off than any path
  Eigen::ArrayXd borders_;                ///< up to where the force of an open stop hardly changes
  Eigen::ArrayXd w_, wv_, w_new_, wv_new_, reach_;
  Eigen::ArrayXd largest_w_, largest_wv_;  ///< so far
  std::vector<Pair> pairs_;
  std::vector<PairScale> pair_scales_;
  std::vector<Index> pair_of_;                       ///< of each stop; -1: none
  Eigen::ArrayXd a_;                                 ///< accelerations at the start, where they were asked for
  Eigen::ArrayXd pull_sizes_, bends_;                ///< FarPull::largest(), and the width of the law's bend
  Eigen::Array<bool, Eigen::Dynamic, 1> is_steady_;  ///< surely; of the others is_steady() knows
  double largest_shift_ = 0.0;                       ///< of a stop in the step, by a pull
  Eigen::ArrayXd shares_;                            ///< displacement scale of a stop over the largest one
  double largest_felt_shift_ = 0.0;                  ///< of a stop by a pull, over its share
  double unsmooth_ = 0.0;                            ///< the error of outputs, in parts of what it may be
  double load_swing_ = 0.0;                          ///< how far loads can carry a stop away from the cubic
  double swing_ = 0.0;                               ///< and modes too
  Eigen::ArrayXd hv_;                                ///< speed times h at the start
  dynamics::StopMotion path_;  ///< with all forces found so far; outside near_registers_ once they are complete
  dynamics::StopMotion seen_;  ///< what the path of a stop was when its force was found
  std::vector<Index> near_registers_, far_registers_;  ///< those that hold reachable stops, and all others
  Eigen::ArrayXd bulge_;                               ///< by which the middle departs from the cubic through the ends
  Eigen::ArrayXd excess_;                              ///< by which a bound of the path is beyond the gap
  std::array<Eigen::ArrayXd, 3> force_;
  std::vector<Index> reachable_;  ///< near their gap, or pulled by what is no constant
  std::vector<Index> touched_, far_;
  std::vector<Index> jumping_;       ///< of those far away, the ones whose pull changes its sign
  std::vector<ForceMoments> jumps_;  ///< their forces
  std::vector<bool> is_touched_;
  double longest_near_;               ///< longest_near_stops(), s
  double tried_h_ = 0.0, end_ = 0.0;  ///< of the last attempt: its length and when it ends
  bool is_near_ = false;              ///< any stop
  double error_ = 0.0;
};

}  // namespace butee::integrators

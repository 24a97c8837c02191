#pragma once

#include <array>
#include <vector>

#include "butee/dynamics/modal_motion.hpp"
#include "butee/dynamics/modal_system.hpp"
#include "integrators/exponential_step.hpp"
#include "integrators/far_pull.hpp"
#include "integrators/modal_energy.hpp"
#include "integrators/oscillator.hpp"

namespace butee::integrators {

/// What ExponentialStep does, for a single DOF with a single stop under harmonic loads: the same arithmetic in plain
/// numbers, without a loop over modes or stops.
class SingleStep {
 public:
  /// A system of that kind.
  static bool can_take(const dynamics::Dynamics& dynamics);

  SingleStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, int order, const StepGoal& goal,
             std::size_t most);

  /// q, v, how often the phases of the loads were turned, and those.
  Index memory_size() const { return 3 + 2 * static_cast<Index>(harmonics_.size()); }
  void complete(double* memory) const;
  void begin(double t, const double* memory, StopScale scale);
  void save(double* memory) const;
  Trial attempt_rung(int level);
  Trial attempt_until(double t);
  /// Nothing: one DOF starts from rest as t^2 or t^3, which a cubic holds.
  void expect_motion(int) {}
  void accept(double t);

  double t() const { return knots_.back().t; }
  const double* q() const { return &now_.q; }
  const double* v() const { return &now_.v; }
  StopScale scale() const { return scale_; }
  bool is_quiet() const { return is_quiet_; }
  double time_to_stop() const;
  int spare_rungs() const { return rungs_up(unsmooth_); }
  double error_ratio() const { return error_ / (tolerance_ * scale_.displacement); }
  bool is_easy() const { return error_ < kEasy * tolerance_ * scale_.displacement; }
  static constexpr bool has_stops() { return true; }

  std::span<const double> knots() const;
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out);
  std::span<const time::EnergyAt> energies(std::span<const double> instants);

 private:
  /// So often phases are turned before they are computed anew: a turn costs their last digit.
  static constexpr int kMostTurns = 32;

  struct Point {
    double q, v;
  };
  /// A dynamics::StepFlow of one mode and one stop.
  struct Flow {
    int level = 0;
    double h = 0.0;  ///< 0: not filled yet
    double qq, qv, vq, vv, half_qq, half_qv, swing_q, swing_v, swing_harmonics;
    std::array<double, 3> force_q, force_v;
    PathCoupling coupling;
    OwnForce::Matrix closed_inverse;
    struct Harmonic {
      std::array<double, 6> load;  ///< q, v and half_q by its cosine and its sine
      Phase turn;                  ///< over the step
    };
    std::vector<Harmonic> harmonics;
  };
  /// Where a step begins or ends.
  struct Knot {
    double t;
    Point at;
    bool has_motion = false;  ///< motion is known
    Motion motion{};
    // Of the step from here: the speeds times h at its ends, the bulge of its path, and the force.
    double hv0 = 0.0, hv1 = 0.0, bulge = 0.0;
    ForceMoments force{};
  };

  void fill(dynamics::StepFlow& from, Flow& flow) const;
  void find_phases();  ///< of the last knot
  Phase* phases(std::size_t knot) { return phases_.data() + knot * harmonics_.size(); }
  Trial attempt(const Flow& flow);
  /// Fills force_ along the path that begins at w, hv and would end at path_ without the stop.
  Trial iterate(const Flow& flow, double w, double hv);
  /// Whether the pull of the open stop is a constant, as far as the tolerance can tell.
  bool is_steady(const Flow& flow, double w, double reach) const;
  const Motion& motion_at(std::size_t knot);
  /// By how much a path is beyond the gap on a side on which the stop acts; negative where it is not.
  double beyond(const StopPath& path) const;
  StopPath path_from(std::size_t knot) const;
  /// Whether the quintic is as good as the motion in the step from a knot.
  bool is_quintic(std::size_t knot) const;
  /// Within that.
  Motion motion_within(std::size_t knot, double t);
  Motion motion_of(Point at, double harmonic_force) const;

  dynamics::Dynamics& dynamics_;
  dynamics::ModalSystem& modal_;
  std::size_t orders_;
  StepGoal goal_;
  double tolerance_, output_tolerance_, load_frequency_ = 0.0;
  StopForce stop_;
  OwnForce own_;
  FarPull pull_;
  double gap_, upper_, lower_;  ///< where the stop acts; infinite where it does not
  double longest_near_;         ///< longest_near_stops(), s
  double calm_border_, stop_shape_, square_, decay_;
  const std::vector<dynamics::ModalHarmonic>& harmonics_;

  std::array<Flow, 8> flows_;  ///< of rungs, by their last three bits
  Flow odd_;
  std::vector<Knot> knots_;
  Oscillator oscillator_;
  /// The motion that a load keeps up by itself.
  struct Kept {
    double cosine, sine;
  };
  std::vector<Kept> kept_;        ///< by load
  bool is_kept_ = true;           ///< no load is in resonance
  dynamics::ModalMotion motion_;  ///< where oscillator_ cannot
  Eigen::VectorXd padded_q_, padded_v_;
  std::array<Eigen::VectorXd, 3> padded_force_;
  ModalEnergy energy_;
  std::vector<double> times_;    ///< of the knots
  std::vector<Phase> phases_;    ///< by knot and harmonic: each is the one before, turned
  int turns_ = 0;                ///< since the last that was computed from its time
  const Flow* tried_ = nullptr;  ///< of the last attempt

  Point now_{}, next_{};
  StopScale scale_;
  double w_next_ = 0.0, error_ = 0.0, unsmooth_ = 0.0;
  bool is_quiet_ = false;
  std::array<double, 3> path_{};  ///< end, speed times h, middle, with the forces found so far
  ForceMoments force_{};
};

}  // namespace butee::integrators

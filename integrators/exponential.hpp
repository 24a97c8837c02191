#pragma once

#include <memory>
#include <vector>

#include "butee/solve/modal_system.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/quintic.hpp"
#include "integrators/stop_path.hpp"

namespace butee::integrators {

struct ExponentialOptions {
  double tolerance = 1e-4;  ///< relative to the largest displacement of a stop so far
  int order = 6;            ///< 2, 4 or 6
  Index modes = 0;          ///< the lowest; 0: all, but of large systems 300
};

/// exponential: the linear part propagated exactly in modal coordinates, the stops by the projection of their force.
///
///     q(t+h) = flow(q, load) + sum_k R_k(omega h) Phi^T f_k,    f_k = (2k+1) int_0^1 P_k(s) F_c(w(s)) ds
///
/// All modes, damping and harmonic or piecewise linear loads are without error; a scene without stops goes from output
/// to output. Over a step the force of a stop is projected onto the Legendre polynomials P_0, P_1, P_2 along its path
/// w(s), a quartic through the displacements and speeds at both ends and the displacement in the middle, of which the
/// forces are a part: f is found by iteration over the stops within reach alone, which contracts by (h omega_c)^2/12 or
/// faster, omega_c^2 = k_c S M^-1 S^T. Kinks of the law within a step are integrated piece by piece, so that they do
/// not cost the order and need no landing.
///
/// Order 2 (f_0), 4 (f_0, f_1, a cubic path) or 6 away from contact changes and 4 with small constants across them.
/// Steps lie on a ladder of ratio sqrt 2, chosen by the displacement in the middle, which the flow over half a step
/// gives independently of the path. Checked in tests/models/exponential_test.cpp against 80-bit references.
/// Sources: energy-preserving collocation by projection, E. Hairer, JNAIAM 5 (2010) 73-84; exponential integrators, M.
/// Hochbruck and A. Ostermann, Acta Numerica 19 (2010) 209-286, doi 10.1017/S0962492910000048.
class Exponential final : public time::Integrator {
 public:
  Exponential(solve::Dynamics& dynamics, const ExponentialOptions& options);

  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State& state) const override;
  bool lands_on_outputs() const override { return stops_.empty(); }
  std::span<const double> knots(const time::State& from, const time::State& to) const override;

 private:
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override { return {true, report.error}; }
  };

  /// A stop within reach during a step.
  struct Active {
    Index stop;
    double w0, hv0;          ///< at the start
    double w1, hv1, middle;  ///< at the end and in the middle, with all forces found so far
    double bulge;            ///< by which the middle departs from the cubic through the ends
    ForceMoments force;
    StopForce::Course course;
  };

  enum class Trial { accepted, too_long, not_finite };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  void do_interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                      time::Interpolated out) const override;

  /// Takes steps from `from` until `step` is done or the block is full, filling the knots; the number of steps.
  time::StepReport follow(const time::State& from, const time::Step& step);
  Trial try_step(solve::StepFlow& flow, double t);
  /// cos and sin of the harmonic loads at the start of a step.
  void note_phases(double t);
  void propagate(const solve::ModalFlow& flow, double t, bool with_speed, Eigen::ArrayXd& q, Eigen::ArrayXd& v) const;
  void find_active(const solve::StepFlow& flow, double t);
  void add_far_forces(const solve::StepFlow& flow);
  Trial iterate(solve::StepFlow& flow);
  /// Takes the active stops in turn, each with the forces of all others as they are; the largest change of a path.
  double sweep(solve::StepFlow& flow, std::size_t orders, bool uses_bulge);
  void apply_forces(const solve::StepFlow& flow);
  double next_kink(double t) const;
  int find_first_level() const;
  bool holds(const time::State& from, double t_end) const;
  void complete_knot(std::size_t knot);
  Motion motion_at(std::size_t knot, Index dof);
  /// Fills courses_ between a knot and the next.
  void lay_courses(std::size_t knot, std::span<const Index> dofs);

  /// Without stops: the flow from a knot to t.
  void evaluate_exactly(std::size_t knot, double t, std::span<const Index> dofs, time::Interpolated out);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  ExponentialOptions options_;
  Controller controller_;
  solve::ModalSystem& modal_;
  std::vector<StopForce> stops_;
  Eigen::ArrayXd gaps_;
  bool has_far_forces_ = false;
  std::vector<double> kinks_;
  double tolerance_;  ///< of the displacement in the middle, relative to scale_

  // The state within a block.
  Eigen::ArrayXd q_, v_;
  Eigen::ArrayXd w_, wv_;  ///< displacements and speeds of the stops
  int first_level_ = 0, level_ = 0;
  double scale_ = 0.0;

  struct Phase {
    double cosine, sine;
  };
  std::vector<Phase> phases_;

  // A trial.
  Eigen::ArrayXd q_new_, v_new_, q_half_, w_new_, wv_new_, reach_;
  std::vector<Active> active_;
  std::vector<Index> far_;
  std::array<Eigen::ArrayXd, 3> sums_;
  double error_ = 0.0;

  // The knots of the last block, for its interpolation.
  std::vector<double> times_;
  Eigen::MatrixXd knot_q_, knot_v_, knot_a_;
  std::vector<bool> has_acceleration_;
  Vector stop_force_, far_forces_;
  std::size_t course_knot_ = kNone;
  std::vector<Index> course_dofs_;
  std::vector<Motion> course_ends_;
  std::vector<Quintic> courses_;
  double begin_t_ = 0.0, end_t_ = -1.0;
  Vector begin_memory_;
};

}  // namespace butee::integrators

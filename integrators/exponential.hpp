#pragma once

#include <memory>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/exponential_step.hpp"
#include "integrators/single_step.hpp"

namespace butee::integrators {

struct ExponentialOptions {
  double tolerance = 1e-4;  ///< relative to the scales of what moves (integrators/error-control.md)
  double run_time = 1.0;    ///< s
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
/// forces are a part: f is found by iteration over the stops within reach alone, which contracts by (h omega_c)^2/26 or
/// faster, omega_c^2 = k_c S M^-1 S^T. Kinks of the law within a step are integrated piece by piece, so that they do
/// not cost the order and need no landing.
///
/// Order 2 (f_0), 4 (f_0, f_1, a cubic path) or 6 away from contact changes and 4 with small constants across them.
/// Steps lie on a ladder of ratio sqrt 2, chosen by the displacement in the middle, which the flow over half a step
/// gives independently of the path. Checked in tests/models/exponential_test.cpp against 80-bit references.
/// Sources: energy-preserving collocation by projection, E. Hairer, JNAIAM 5 (2010) 73-84; exponential integrators, M.
/// Hochbruck and A. Ostermann, Acta Numerica 19 (2010) 209-286, doi 10.1017/S0962492910000048.
///
/// `Step` takes the steps: ExponentialStep those of any system, SingleStep those of one DOF with one stop, the same
/// arithmetic in plain numbers. make_exponential() knows which.
template <class Step>
class Exponential final : public time::Integrator {
 public:
  Exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

  bool minds_load_kinks() const override { return true; }
  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State& state) const override;
  bool lands_on_outputs() const override { return !step_.has_stops(); }
  std::span<const double> knots(const time::State& from, const time::State& to) const override;
  std::span<const time::EnergyAt> energies(const time::State& from, const time::State& to,
                                           std::span<const double> instants) const override;
  time::DenseOutput dense_output() const override {
    return step_.has_stops() ? time::DenseOutput::near_quintic : time::DenseOutput::other;
  }
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) const override;

 private:
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override { return {true, report.error}; }
  };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  void do_interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                          std::span<const Index> dofs, time::Interpolated out) const override;

  /// Takes up to `most` steps from `from` on towards `end`, filling the knots, and none from `until` on.
  time::StepReport follow(const time::State& from, double end, int most, double until);
  /// Takes a single one, to `end` at the latest; false where none fits or none can be taken.
  bool advance(double end, time::StepReport& report);
  double next_kink(double t) const;
  int find_first_level() const;
  bool holds(const time::State& from, double t_end) const;
  /// The steps of a block, taken again where it is no longer the last.
  Step& recall(const time::State& from, const time::State& to) const;

  ExponentialOptions options_;
  Controller controller_;
  dynamics::ModalSystem& modal_;
  Step step_;
  std::vector<double> kinks_;
  int first_level_ = 0, level_ = 0;
  bool is_quiet_ = false;
  int quiet_rungs_ = 0;

  // What the knots belong to.
  double begin_t_ = 0.0, end_t_ = -1.0;
  Vector begin_memory_;
};

std::unique_ptr<time::Integrator> make_exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

}  // namespace butee::integrators

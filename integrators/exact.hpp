#pragma once

#include "butee/time/integrator.hpp"
#include "integrators/taylor_path.hpp"

namespace butee::integrators {

/// exact: Taylor series of high order from one change of contact to the next; every change is
/// located.
///
/// Between changes the contact forces are analytic functions of the motion. With a piecewise linear
/// law the stops are open or closed springs. With a smooth law the length of a series follows from
/// the decay of its terms; a boundary layer near the path shortens it. The truncation error is
/// below `series_tolerance`, by default far below rounding, so that only rounding errors remain;
/// otherwise the method has order `order`. The `tolerance` of a scene has no effect. A step takes
/// `order` evaluations of M^-1 (F - C v - K x) and has a length of 2 to 3 divided by the highest
/// frequency, so that the cost grows in proportion to this frequency. Checked in
/// tests/models/exact_test.cpp against a solution in 80-bit arithmetic. Source of the recurrence:
/// R. Barrio, Appl. Math. Comput. 163 (2005) 525-545, doi 10.1016/j.amc.2004.02.015.
class Exact final : public time::Integrator {
 public:
  static constexpr int kOrder = 30;
  static constexpr double kSeriesTolerance = 1e-20;

  /// `series_tolerance` is the size of the last terms of a series relative to the largest.
  Exact(dynamics::Dynamics& dynamics, int order, double series_tolerance);

  time::Traits traits() const override {
    return {.handles_load_discontinuities = true, .follows_contact_phases = true};
  }
  const time::StepController* controller() const override { return &controller_; }
  /// The length over which the series at the start is accurate, s.
  double first_step(const time::State&) const override { return first_step_; }

 private:
  /// Accepts every step; the next step is as long as the last series is accurate.
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double h, const time::StepReport& report) const override;
  };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return path_; }

  Controller controller_;
  TaylorPath path_;                         ///< of the last step
  double first_length_, first_step_ = 0.0;  ///< s
};

}  // namespace butee::integrators

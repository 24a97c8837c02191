#pragma once

#include "integrators/local_error.hpp"

namespace butee::integrators {

/// Local errors of second-order methods from the accelerations of two steps: those of the trapezoidal rule,
///
///     e_x = h^2 (a_{n+1} - a_n)/12,    e_v = h^3 a''/12,    a'' = 2 [(a_{n+1} - a_n)/h - (a_n - a_{n-1})/h_old]/(h +
///     h_old)
///
/// The memory of a state holds LocalErrorControl's part, then h_old (0 at the start) and (a_n - a_{n-1})/h_old.
class AccelerationError {
 public:
  AccelerationError(solve::Dynamics& dynamics, double tolerance)
      : control_(dynamics, tolerance, {3.0, 2.0, 1.0, kKink}, LocalErrorControl::Steps::ladder) {}

  const time::StepController& controller() const { return control_.controller(); }
  double first_step() const { return control_.first_step(); }
  void start(time::State& state);
  void judge(const time::State& from, time::State& to, double h, time::StepReport& report);
  /// Of a state whose acceleration was replaced: the next step is judged as the first one is.
  static void forget_slope(time::State& state) { state.memory.segment(kOldStep, 1 + state.x.size()).setZero(); }

 private:
  static constexpr double kKink = 4.0;
  static constexpr Index kOldStep = LocalErrorControl::kMemory, kSlope = kOldStep + 1;

  LocalErrorControl control_;
  Vector slope_, error_x_, error_v_;
};

}  // namespace butee::integrators

#pragma once

#include "integrators/local_error.hpp"

namespace butee::integrators {

/// Estimates the local errors of second-order methods from the accelerations of two steps, as those
/// of the trapezoidal rule:
///
///     e_x = h^3 s/12,    e_v = h^3 a''/12,    s = (a_{n+1} - a_n)/d,    a'' = 2 (s - s_old)/(d + d_old)
///
/// a_{n+1} is an acceleration that satisfies the equations of motion at t_{n+1} - lag, and d is the
/// time between a_n and a_{n+1}. The memory of a state holds LocalErrorControl's part, then h, lag,
/// d (0 if s is not known), s and a_n.
class AccelerationError {
 public:
  /// `kink`, `contact_change`, `stable_turn`, `stable_decay`: as in LocalErrorControl::Orders.
  AccelerationError(dynamics::Dynamics& dynamics, const Goal& goal, double kink, double contact_change = 10.0,
                    double stable_turn = std::numeric_limits<double>::infinity(),
                    double stable_decay = std::numeric_limits<double>::infinity())
      : control_(dynamics, goal,
                 {.estimate = 3.0,
                  .method = 2.0,
                  .constant = kConstant,
                  .contact_change = contact_change,
                  .kink = kink,
                  .stable_turn = stable_turn,
                  .stable_decay = stable_decay},
                 LocalErrorControl::Steps::geometric) {}

  const time::StepController& controller() const { return control_.controller(); }
  double first_step() const { return control_.first_step(); }
  void start(time::State& state);
  /// The same with the acceleration at the end of the step (lag 0).
  void judge(const time::State& from, time::State& to, double h, time::StepReport& report) {
    judge(from, to, h, to.a, 0.0, report);
  }
  void judge(const time::State& from, time::State& to, double h, ConstVectorRef a, double lag,
             time::StepReport& report);
  /// Adds a jump of the acceleration at a state to a_n; the slope remains.
  static void add_jump(time::State& state, ConstVectorRef jump) {
    state.memory.segment(place(state) + kSlope + state.x.size(), state.x.size()) += jump;
  }
  /// Discards the slope s at a state at which the motion is not smooth; the next step is judged as
  /// a first step.
  static void forget_slope(time::State& state) { state.memory[place(state) + kDistance] = 0.0; }
  /// Sets s, the rate of the acceleration, to `slope` at a state at which the motion is not smooth.
  static void take_slope(time::State& state, ConstVectorRef slope) {
    const Index at = place(state);
    // h and d are practically zero, since the slope belongs to one instant.
    state.memory.segment(at + kStep, 3) << kInstant, 0.0, kInstant;
    state.memory.segment(at + kSlope, state.x.size()) = slope;
  }

  /// The length of the step that ended at this state, s; 0 if no slope is known.
  static double last_step(const time::State& state) {
    return state.memory[place(state) + kDistance] > 0.0 ? state.memory[place(state) + kStep] : 0.0;
  }
  /// The acceleration at t + offset, extrapolated linearly with the last slope.
  static auto extrapolated(const time::State& state, double offset) {
    const Index n = state.x.size(), at = place(state);
    return state.memory.segment(at + kSlope + n, n) +
           (state.memory[at + kLag] + offset) * state.memory.segment(at + kSlope, n);
  }

 private:
  static constexpr double kConstant = 1.0;
  static constexpr double kInstant = 1e-100;
  /// Offsets behind the control's memory.
  static constexpr Index kStep = 0, kLag = 1, kDistance = 2, kSlope = 3;
  static Index place(const time::State& state) { return LocalErrorControl::memory_size(state.x.size()); }

  LocalErrorControl control_;
  Vector slope_, error_x_, error_v_;
};

}  // namespace butee::integrators

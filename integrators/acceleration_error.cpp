#include "integrators/acceleration_error.hpp"

namespace butee::integrators {

void AccelerationError::start(time::State& state) {
  const Index n = state.x.size();
  state.memory.setZero(kSlope + 2 * n);
  state.memory.tail(n) = state.a;
  control_.start(state);
}

void AccelerationError::judge(const time::State& from, time::State& to, double h, ConstVectorRef a, double lag,
                              time::StepReport& report) {
  const Index n = to.x.size();
  const double distance = h - lag + from.memory[kLag], old_distance = from.memory[kDistance];
  slope_ = (a - from.memory.segment(kSlope + n, n)) / distance;
  error_x_ = (h * h * h / 12.0) * slope_;
  if (old_distance > 0.0)
    error_v_ = (h * h * h / (6.0 * (distance + old_distance))) * (slope_ - from.memory.segment(kSlope, n));
  else
    error_v_ = (h * h / 12.0) * slope_;
  control_.judge(from, to, h, error_x_, error_v_, report);
  to.memory.segment(kStep, 3) << h, lag, distance;
  to.memory.segment(kSlope, n) = slope_;
  to.memory.segment(kSlope + n, n) = a;
}

}  // namespace butee::integrators

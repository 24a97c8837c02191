#include "integrators/acceleration_error.hpp"

namespace butee::integrators {

void AccelerationError::start(time::State& state) {
  const Index n = state.x.size();
  state.memory.setZero(place(state) + kSlope + 2 * n);
  state.memory.tail(n) = state.a;
  control_.start(state);
}

void AccelerationError::judge(const time::State& from, time::State& to, double h, ConstVectorRef a, double lag,
                              time::StepReport& report) {
  const Index n = to.x.size(), at = place(to);
  const auto old_slope = from.memory.segment(at + kSlope, n);
  const double distance = h - lag + from.memory[at + kLag], old_distance = from.memory[at + kDistance];
  slope_ = (a - from.memory.segment(at + kSlope + n, n)) / distance;
  error_x_ = (h * h * h / 12.0) * slope_;
  if (old_distance > 0.0)
    error_v_ = (h * h * h / (6.0 * (distance + old_distance))) * (slope_ - old_slope);
  else
    error_v_ = (h * h / 12.0) * slope_;
  control_.judge(from, to, h, error_x_, error_v_, report);
  to.memory.segment(at + kStep, 3) << h, lag, distance;
  to.memory.segment(at + kSlope, n) = slope_;
  to.memory.segment(at + kSlope + n, n) = a;
}

}  // namespace butee::integrators

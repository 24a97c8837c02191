#include "integrators/acceleration_error.hpp"

namespace butee::integrators {

void AccelerationError::start(time::State& state) {
  state.memory.setZero(kSlope + state.x.size());
  control_.start(state);
}

void AccelerationError::judge(const time::State& from, time::State& to, double h, time::StepReport& report) {
  const Index n = to.x.size();
  const double old_h = from.memory[kOldStep];
  slope_ = (to.a - from.a) / h;
  error_x_ = (h * h * h / 12.0) * slope_;
  if (old_h > 0.0)
    error_v_ = (h * h * h / (6.0 * (h + old_h))) * (slope_ - from.memory.segment(kSlope, n));
  else
    error_v_ = (h * h / 12.0) * slope_;
  control_.judge(from, to, h, error_x_, error_v_, report);
  to.memory[kOldStep] = h;
  to.memory.segment(kSlope, n) = slope_;
}

}  // namespace butee::integrators

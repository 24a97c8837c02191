#include "integrators/extrapolation.hpp"

#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

constexpr std::array<int, 4> kParts = {2, 4, 6, 8};
/// Measured in tests/conformance/error_constant_test.cpp.
constexpr double kConstant = 7.6, kContactChange = 40.0, kKink = 9.2e-3;
/// h omega and h c/m of the whole step at which the modulus of the stability polynomial exceeds 1.
constexpr double kLimit = 3.85286858, kDampingLimit = 5.54957408;
/// Longest h c/m of a step. The error of a mode is three times its estimate there; at 11.3 the estimate
/// vanishes while the mode grows 860 times.
constexpr double kLongest = 8.0;

}  // namespace

Extrapolation::Extrapolation(dynamics::Dynamics& dynamics, const Goal& goal)
    : Integrator(dynamics),
      control_(dynamics, goal,
               {.estimate = 7.0,
                .method = 8.0,
                .constant = kConstant,
                .contact_change = kContactChange,
                .kink = kKink,
                .stability = kLimit,
                .damping = kLongest,
                .stable_turn = kLimit,
                .stable_decay = kDampingLimit,
                .share = 0.002,
                .has_quintic_outputs = true},
               LocalErrorControl::Steps::any) {
  for (std::size_t i = 0; i < kColumns; ++i) x_[i] = v_[i] = Vector::Zero(dynamics.size());
  a_ = Vector::Zero(dynamics.size());
}

void Extrapolation::do_start(time::State& state) {
  state.memory.resize(LocalErrorControl::memory_size(state.x.size()));
  control_.start(state);
}

void Extrapolation::midpoint(const time::State& from, const time::Step& step, int parts, Vector& x, Vector& v) {
  const double d = step.h / parts;
  old_x_ = from.x;
  old_v_ = from.v;
  new_x_ = from.x + d * from.v;
  new_v_ = from.v + d * from.a;
  for (int m = 1; m <= parts; ++m) {
    if (m == parts) {
      dynamics().acceleration(step.t_end, new_x_, new_v_, a_);
      break;
    }
    control_.look(new_x_);
    dynamics().acceleration(from.t, m * d, new_x_, new_v_, a_);
    next_x_ = old_x_ + 2.0 * d * new_v_;
    next_v_ = old_v_ + 2.0 * d * a_;
    old_x_.swap(new_x_);
    old_v_.swap(new_v_);
    new_x_.swap(next_x_);
    new_v_.swap(next_v_);
  }
  x = 0.5 * (new_x_ + old_x_ + d * new_v_);
  v = 0.5 * (new_v_ + old_v_ + d * a_);
}

time::StepReport Extrapolation::do_step(const time::State& from, const time::Step& step, time::State& to) {
  control_.begin(from);
  // x_[k] holds T_{j,k+1} of the last row j; a row is computed from its first column to its last.
  for (std::size_t j = 0; j < kColumns; ++j) {
    midpoint(from, step, kParts[j], to.x, to.v);
    for (std::size_t k = 0; k < j; ++k) {
      const double ratio = static_cast<double>(kParts[j]) / kParts[j - k - 1], divisor = ratio * ratio - 1.0;
      next_x_ = to.x + (to.x - x_[k]) / divisor;
      next_v_ = to.v + (to.v - v_[k]) / divisor;
      x_[k] = to.x;
      v_[k] = to.v;
      to.x.swap(next_x_);
      to.v.swap(next_v_);
    }
    x_[j] = to.x;
    v_[j] = to.v;
  }
  // The last row: x_[2] is of order 6, x_[3] of order 8.
  next_x_ = to.x - x_[kColumns - 2];
  next_v_ = to.v - v_[kColumns - 2];
  to.a = from.a;
  time::StepReport report;
  control_.judge(from, to, step.h, next_x_, next_v_, report);
  if (report.error <= 1.0 && report.status == time::StepStatus::ok)
    dynamics().acceleration(step.t_end, to.x, to.v, to.a);
  return report;
}

time::IntegratorType extrapolation8_type() {
  return {.name = "extrapolation8",
          .aliases = {"GBS8"},
          .summary = "extrapolated midpoint rule of order 8, explicit, steps by the local error",
          .parameters = {LocalErrorControl::parameter(1e-6, 1e-12)},
          .order = 8.0,
          .stability_limit = kLimit,
          .damping_limit = kDampingLimit,
          .finds_first_step = true,
          .contacts = time::ContactSupport::all,
          .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<Extrapolation>(dynamics, Goal::read(p));
          }};
}

}  // namespace butee::integrators

#include "integrators/dormand_prince.hpp"

#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

constexpr std::array<double, 7> kTimes = {0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
constexpr double kA[7][6] = {{},
                             {1.0 / 5},
                             {3.0 / 40, 9.0 / 40},
                             {44.0 / 45, -56.0 / 15, 32.0 / 9},
                             {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                             {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                             {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
constexpr std::array<double, 7> kError = {71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                          -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
/// Measured in tests/conformance/error_constant_test.cpp.
constexpr double kConstant = 1.5, kContactChange = 40.0, kKink = 0.0225;
/// Limit of h omega on the imaginary axis beyond which undamped motion grows rapidly.
constexpr double kLimit = 1.0;
/// h omega and h c/m (negative real axis) at which |R| = 1 for R(z) = 1 + z + ... + z^5/120 +
/// z^6/600.
constexpr double kStabilityLimit = 0.99718900, kDampingLimit = 3.30656789;

}  // namespace

DormandPrince::DormandPrince(dynamics::Dynamics& dynamics, const Goal& goal)
    : Integrator(dynamics),
      control_(dynamics, goal,
               {.estimate = 5.0,
                .method = 5.0,
                .constant = kConstant,
                .contact_change = kContactChange,
                .kink = kKink,
                .stable_turn = kStabilityLimit,
                .stable_decay = kDampingLimit,
                .share = 0.05,
                .has_quintic_outputs = true},
               LocalErrorControl::Steps::any),
      stiffness_("dopri5", kLimit) {
  for (std::size_t i = 0; i < kStages; ++i) v_[i] = a_[i] = Vector::Zero(dynamics.size());
}

void DormandPrince::do_start(time::State& state) {
  state.memory.resize(LocalErrorControl::memory_size(state.x.size()));
  control_.start(state);
}

time::StepReport DormandPrince::do_step(const time::State& from, const time::Step& step, time::State& to) {
  const double h = step.h;
  control_.begin(from);
  v_[0] = from.v;
  a_[0] = from.a;
  for (std::size_t i = 1; i < kStages; ++i) {
    if (i + 1 == kStages) x_before_ = x_;
    x_ = from.x;
    v_[i] = from.v;
    for (std::size_t j = 0; j < i; ++j) {
      if (kA[i][j] == 0.0) continue;
      x_ += (h * kA[i][j]) * v_[j];
      v_[i] += (h * kA[i][j]) * a_[j];
    }
    // The second stage has no weight, and the last one is the end of the step.
    if (i > 1 && i + 1 < kStages) control_.look(x_);
    if (i + 2 < kStages)
      dynamics().acceleration(from.t, kTimes[i] * h, x_, v_[i], a_[i]);
    else
      dynamics().acceleration(step.t_end, x_, v_[i], a_[i]);
  }
  to.x = x_;
  to.v = v_.back();
  to.a = a_.back();
  error_x_.setZero(x_.size());
  error_v_.setZero(x_.size());
  for (std::size_t i = 0; i < kStages; ++i) {
    error_x_ += (h * kError[i]) * v_[i];
    error_v_ += (h * kError[i]) * a_[i];
  }
  time::StepReport report;
  control_.judge(from, to, h, error_x_, error_v_, report);
  if (report.error <= 1.0) stiffness_.look(step.t_end, h, (a_[6] - a_[5]).norm(), (x_ - x_before_).norm());
  return report;
}

time::IntegratorType dopri5_type() {
  return {.name = "dopri5",
          .aliases = {"DOPRI5"},
          .summary = "explicit Runge-Kutta of order 5(4), steps by the local error",
          .parameters = {LocalErrorControl::parameter(1e-4, 1e-11)},
          .order = 5.0,
          .stability_limit = kStabilityLimit,
          .damping_limit = kDampingLimit,
          .finds_first_step = true,
          .contacts = time::ContactSupport::all,
          .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return std::make_unique<DormandPrince>(dynamics, Goal::read(p));
          }};
}

}  // namespace butee::integrators

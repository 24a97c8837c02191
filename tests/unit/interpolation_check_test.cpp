#include "integrators/exponential/interpolation_check.hpp"

#include <cmath>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/quintic.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::interpolation_check_test {
namespace {

using integrators::InterpolationCheck;
using integrators::Motion;
using integrators::TriedStep;

constexpr double kOmega = 2.0, kTolerance = 1e-3;
const std::string kScene = mass_on_spring("4.0", R"(
[[contact]]
type = "stop"
nodes = "m"
gap = 10.0
stiffness = 3.0
)");

/// The motion cos(omega (t + t0)) of the mass.
struct Vibration {
  SceneRun run{kScene};
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  TriedStep step;

  void set(double t0, double h) {
    step.h = h;
    step.t_end = h;
    step.reached = {1.0, kOmega};
    step.breakpoint = 0.0;
    fill(step.from, t0);
    fill(step.to, t0 + h);
    fill(step.middle, t0 + 0.5 * h);
  }
  void fill(integrators::ModalState& state, double t) {
    state.resize(modal);
    state.q[0] = modal.shapes()(0, 0) * std::cos(kOmega * t);
    state.v[0] = -modal.shapes()(0, 0) * kOmega * std::sin(kOmega * t);
    state.find_stops(modal.stop_shapes());
  }
};

double largest_miss(double t0, double h) {
  const auto at = [&](double t) {
    const double x = std::cos(kOmega * t);
    return Motion{x, -kOmega * std::sin(kOmega * t), -kOmega * kOmega * x};
  };
  const integrators::Quintic quintic(h, at(t0), at(t0 + h));
  double largest = 0.0;
  for (double s = 0.0; s <= 1.0; s += 1e-3)
    largest = std::max(largest, std::abs(quintic.value(s) - std::cos(kOmega * (t0 + s * h))));
  return largest;
}

TEST(InterpolationCheck, BoundsTheErrorOfQuintics) {
  Vibration vibration;
  InterpolationCheck check(vibration.modal, kTolerance);
  int within = 0;
  for (const double t0 : {0.0, 0.4, 0.8, 1.3})
    for (const double h : {0.1, 0.5, 1.0, 1.5, 2.0}) {
      vibration.set(t0, h);
      const bool is_bounded = check.is_bounded(vibration.modal.odd(h), vibration.step, 0.0);
      EXPECT_EQ(is_bounded, check.error() <= 1.0);
      EXPECT_GE(check.error() * kTolerance * (1.0 + 1e-6) + 1e-15, largest_miss(t0, h)) << t0 << " " << h;
      within += is_bounded;
    }
  EXPECT_EQ(within, 8);
}

/// The error is known from the middle of the step: from the displacement there, where an even error is
/// largest, or from the velocity there, which gives an estimate of an odd error. For a sum of both, the
/// larger part is known.
TEST(InterpolationCheck, KnowsTheErrorOfQuinticsByTheMiddleOfTheStep) {
  Vibration vibration;
  InterpolationCheck check(vibration.modal, kTolerance);
  for (const double t0 : {0.0, 0.4, 0.8, 1.3})
    for (const double h : {1.0, 1.5, 2.0, 2.5}) {
      vibration.set(t0, h);
      const bool is_close = check.is_close(vibration.step, nullptr);
      const double part = largest_miss(t0, h) / kTolerance, halved = vibration.step.breakpoint > 0.0 ? 10.0 : 1.0;
      EXPECT_GT(check.error() * halved, 0.5 * part) << t0 << " " << h;
      EXPECT_LT(check.error() * halved, 1.1 * part) << t0 << " " << h;
      EXPECT_EQ(is_close, check.error() <= 1.0);
      EXPECT_EQ(vibration.step.breakpoint, check.error() * halved > 1.0 ? 0.5 * h : 0.0);
    }
}

}  // namespace
}  // namespace butee::test::interpolation_check_test

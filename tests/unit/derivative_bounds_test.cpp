#include "integrators/exponential/derivative_bounds.hpp"

#include <cmath>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/quintic.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::derivative_bounds_test {
namespace {

using integrators::Motion;

/// The vibration cos(omega t), sampled between the ends of quintics in a step of 3 s; its period is shorter
/// or longer than the step.
TEST(DerivativeBounds, BoundTheDepartureFromQuintics) {
  constexpr double kOmega = 2.0, kStep = 3.0;
  SceneRun run(mass_on_spring("4.0", ""));
  const dynamics::ModalSystem& modal = run.dynamics().modal(0);
  const double shape = modal.shapes()(0, 0), speed = 0.0, there = shape * std::cos(kOmega * kStep),
               speed_there = -shape * kOmega * std::sin(kOmega * kStep);
  integrators::Breakpoints breakpoints(modal, 1);
  breakpoints.add(0.0, &shape, &speed, nullptr);
  breakpoints.add(kStep, &there, &speed_there, nullptr);
  integrators::DerivativeBounds bounds(modal, breakpoints);
  const auto at = [&](double t) {
    const double x = std::cos(kOmega * t);
    return Motion{x, -kOmega * std::sin(kOmega * t), -kOmega * kOmega * x};
  };
  for (const double begin : {0.0, 0.5, 1.2})
    for (const double h : {0.05, 0.3, 1.0, 1.7}) {
      double x = 0.0, v = 0.0, a = 0.0;
      const Index dof = 0;
      bounds.departure(begin, begin + h, {&dof, 1}, {{&x, 1}, {&v, 1}, {&a, 1}});
      const integrators::Quintic quintic(h, at(begin), at(begin + h));
      double off_x = 0.0, off_v = 0.0, off_a = 0.0;
      for (double s = 0.0; s <= 1.0; s += 1e-3) {
        const Motion motion = at(begin + s * h);
        off_x = std::max(off_x, std::abs(quintic.value(s) - motion.x));
        off_v = std::max(off_v, std::abs(quintic.slope(s) - motion.v));
        off_a = std::max(off_a, std::abs(quintic.curvature(s) - motion.a));
      }
      constexpr double kRounding = 1e-12;
      EXPECT_LE(off_x, x + kRounding) << begin << " " << h;
      EXPECT_LE(off_v, v + kRounding) << begin << " " << h;
      EXPECT_LE(off_a, a + kRounding) << begin << " " << h;
      // For one mode with known energy the bound for short steps uses the sixth derivative, omega^6, and is
      // sharp.
      const double sixth = std::pow(kOmega, 6);
      if (h < 0.5) {
        EXPECT_LE(x, 1.01 * integrators::quintic_error(h, sixth).x);
        EXPECT_LE(a, 1.01 * integrators::quintic_error(h, sixth).a);
      }
    }
}

}  // namespace
}  // namespace butee::test::derivative_bounds_test

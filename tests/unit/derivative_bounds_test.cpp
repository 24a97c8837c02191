#include "integrators/exponential/derivative_bounds.hpp"

#include <cmath>
#include <complex>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/quintic.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::derivative_bounds_test {
namespace {

using integrators::Motion;

constexpr double kStep = 3.0;

/// Compares the bounds with the departures of a motion from quintics within a step of kStep s that begins at 0, and
/// tells the bounds.
template <class Motions, class Tell>
void compare(SceneRun& run, const Motions& at, const Tell& tell) {
  const dynamics::ModalSystem& modal = run.dynamics().modal(0);
  const double shape = modal.shapes()(0, 0), q = at(0.0).x / shape, v = at(0.0).v / shape, there = at(kStep).x / shape,
               speed_there = at(kStep).v / shape;
  integrators::Breakpoints breakpoints(modal, 1);
  breakpoints.add(0.0, &q, &v, nullptr);
  breakpoints.add(kStep, &there, &speed_there, nullptr);
  integrators::DerivativeBounds bounds(modal, breakpoints);
  for (const double begin : {0.0, 0.5, 1.2})
    for (const double h : {0.05, 0.3, 1.0, 1.7}) {
      Motion bound{};
      const Index dof = 0;
      bounds.departure(begin, begin + h, {&dof, 1}, {{&bound.x, 1}, {&bound.v, 1}, {&bound.a, 1}});
      const integrators::Quintic quintic(h, at(begin), at(begin + h));
      double off_x = 0.0, off_v = 0.0, off_a = 0.0;
      for (double s = 0.0; s <= 1.0; s += 1e-3) {
        const Motion motion = at(begin + s * h);
        off_x = std::max(off_x, std::abs(quintic.value(s) - motion.x));
        off_v = std::max(off_v, std::abs(quintic.slope(s) - motion.v));
        off_a = std::max(off_a, std::abs(quintic.curvature(s) - motion.a));
      }
      constexpr double kRounding = 1e-12;
      EXPECT_LE(off_x, bound.x + kRounding) << begin << " " << h;
      EXPECT_LE(off_v, bound.v + kRounding) << begin << " " << h;
      EXPECT_LE(off_a, bound.a + kRounding) << begin << " " << h;
      tell(begin, h, bound);
    }
}

/// The vibration cos(omega t), whose period is shorter or longer than the step.
TEST(DerivativeBounds, BoundTheDepartureFromQuintics) {
  constexpr double kOmega = 2.0;
  SceneRun run(mass_on_spring("4.0", ""));
  const auto at = [&](double t) {
    const double x = std::cos(kOmega * t);
    return Motion{x, -kOmega * std::sin(kOmega * t), -kOmega * kOmega * x};
  };
  compare(run, at, [](double, double h, const Motion& bound) {
    // For one mode with known energy the bound for short steps uses the sixth derivative, omega^6, and is sharp.
    const double sixth = std::pow(kOmega, 6);
    if (h > 0.5) return;
    EXPECT_LE(bound.x, 1.01 * integrators::quintic_error(h, sixth).x);
    EXPECT_LE(bound.a, 1.01 * integrators::quintic_error(h, sixth).a);
  });
}

/// x'' + 100 x' + 4 x = 3 sin 5t from x = 1, v = -20: the fast rate of nearly 100/s has decayed after a tenth of a
/// second, and what is left moves with the slow one and the load.
TEST(DerivativeBounds, OfAnOverdampedModeForgetItsFastRate) {
  constexpr double kOmega = 2.0, kDelta = 50.0, kTurn = 5.0;
  SceneRun run(mass_on_spring("4.0",
                              "[damping]\nmass_proportional = 100.0\n[[load]]\ntype = \"harmonic\"\nnode = "
                              "\"m\"\namplitude = 3.0\nangular_frequency = 5.0\nphase = -1.5707963267948966\n"));
  const std::complex<double> steady = 3.0 / std::complex<double>(kOmega * kOmega - kTurn * kTurn, 2.0 * kDelta * kTurn);
  const double kappa = std::sqrt(kDelta * kDelta - kOmega * kOmega), slow = -kDelta + kappa, fast = -kDelta - kappa;
  const double x = 1.0 - steady.imag(), v = -20.0 - kTurn * steady.real();
  const double of_slow = (v - fast * x) / (slow - fast), of_fast = (slow * x - v) / (slow - fast);
  const auto at = [&](double t) {
    const std::complex<double> turning = steady * std::polar(1.0, kTurn * t);
    const double s = of_slow * std::exp(slow * t), f = of_fast * std::exp(fast * t);
    return Motion{s + f + turning.imag(), slow * s + fast * f + kTurn * turning.real(),
                  slow * slow * s + fast * fast * f - kTurn * kTurn * turning.imag()};
  };
  compare(run, at, [&](double begin, double h, const Motion& bound) {
    if (begin == 0.0 || h > 0.5) return;
    const double sixth = std::abs(steady) * std::pow(kTurn, 6) + std::abs(of_slow) * std::pow(slow, 6);
    EXPECT_LE(bound.x, 1.01 * integrators::quintic_error(h, sixth).x);
    EXPECT_LE(bound.v, 1.01 * integrators::quintic_error(h, sixth).v);
  });
}

/// Free motion that decays, from x = 1, v = 30, at damping ratios on both sides of 1 and beside it: the bounds decay,
/// too.
TEST(DerivativeBounds, OfDampedModesForgetTheStart) {
  constexpr double kOmega = 10.0, kX = 1.0, kV = 30.0;
  for (const double ratio : {0.3, 0.9, 0.9975, 1.0, 1.003, 1.1, 3.0}) {
    SceneRun run(
        mass_on_spring("100.0", "[damping]\nmass_proportional = " + std::to_string(2.0 * ratio * kOmega) + "\n"));
    const double delta = ratio * kOmega;
    // sinh(kappa t)/kappa and cosh(kappa t); kappa is imaginary for oscillations.
    const std::complex<double> kappa = std::sqrt(std::complex<double>(delta * delta - kOmega * kOmega));
    const auto at = [&](double t) {
      const double sinh = std::abs(kappa) < 1e-6 ? t : (std::sinh(kappa * t) / kappa).real(),
                   cosh = std::cosh(kappa * t).real(), decay = std::exp(-delta * t);
      const double x = decay * (kX * cosh + (kV + delta * kX) * sinh),
                   v = decay * (kV * cosh - (kOmega * kOmega * kX + delta * kV) * sinh);
      return Motion{x, v, -kOmega * kOmega * x - 2.0 * delta * v};
    };
    double first = 0.0;
    SCOPED_TRACE(ratio);
    compare(run, at, [&](double begin, double h, const Motion& bound) {
      if (h != 0.05) return;
      if (begin == 0.0) first = bound.x;
      if (begin == 1.2) {
        EXPECT_LT(bound.x, 0.2 * first);
      }
    });
  }
}

/// x'' + x' + 1600 x = 3 cos(5t + 1): the steady response alone, and with a free vibration, also one whose speed at the
/// start is twice and in the sense opposite to that of the steady response.
TEST(DerivativeBounds, OfAFastModeAreThoseOfItsSteadyResponseAndFreeVibration) {
  constexpr double kOmega = 40.0, kDelta = 0.5, kTurn = 5.0;
  SceneRun run(mass_on_spring("1600.0",
                              "[damping]\nmass_proportional = 1.0\n[[load]]\ntype = \"harmonic\"\nnode = "
                              "\"m\"\namplitude = 3.0\nangular_frequency = 5.0\nphase = 1.0\n"));
  const std::complex<double> steady = std::polar(3.0, 1.0) /
                                      std::complex<double>(kOmega * kOmega - kTurn * kTurn, 2.0 * kDelta * kTurn),
                             rate(-kDelta, std::sqrt(kOmega * kOmega - kDelta * kDelta));
  for (const double free : {0.0, 1e-2, 2.0 * kTurn * steady.imag() / rate.imag()}) {
    const auto at = [&](double t) {
      const std::complex<double> turning = steady * std::polar(1.0, kTurn * t), left = free * std::exp(rate * t);
      return Motion{turning.real() + left.imag(), -kTurn * turning.imag() + (rate * left).imag(),
                    -kTurn * kTurn * turning.real() + (rate * rate * left).imag()};
    };
    compare(run, at, [&](double, double h, const Motion& bound) {
      if (free != 0.0) return;
      const double sixth = std::abs(steady) * std::pow(kTurn, 6);
      EXPECT_LE(bound.x, 1.01 * integrators::quintic_error(h, sixth).x);
      EXPECT_LE(bound.v, 1.01 * integrators::quintic_error(h, sixth).v);
    });
  }
}

}  // namespace
}  // namespace butee::test::derivative_bounds_test

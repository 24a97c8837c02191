#include "integrators/exponential/oscillator.hpp"

#include <butee/dynamics/modal_propagator.hpp>
#include <gtest/gtest.h>

namespace butee::test::oscillator_test {
namespace {

using Eigen::ArrayXd;
using integrators::Oscillator;

/// Relative to the size of the motion; the closed form loses a digit where it replaces the series.
constexpr double kTight = 1e-11;

TEST(Oscillator, AgreesWithTheFlowInSeriesAndClosedForm) {
  // The force c_0 + c_1 s + c_2 s^2 with s = time/t, in powers of time and in Legendre polynomials.
  const double c0 = 0.7, c1 = -1.3, c2 = 0.4, q = 0.3, v = -0.9;
  int moved = 0;
  for (const double omega : {0.0, 0.02, 1.0, 9.0})
    for (const double delta : {0.0, 0.01, 0.6})
      for (const double t : {1e-3, 0.29, 0.4, 3.0}) {
        const Oscillator oscillator(omega, delta);
        if (!oscillator.can_move(t)) continue;
        ++moved;
        const ArrayXd frequency = ArrayXd::Constant(1, omega), decay = ArrayXd::Constant(1, delta);
        dynamics::ModalPropagator flow(frequency, decay, {}, t);
        flow.refine(frequency, decay);
        const double f[] = {c0 + c1 / 2.0 + c2 / 3.0, (c1 + c2) / 2.0, c2 / 6.0};
        double x = flow.qq()[0] * q + flow.qv()[0] * v, speed = flow.vq()[0] * q + flow.vv()[0] * v;
        for (int k = 0; k < 3; ++k) {
          x += f[k] * flow.force_q(k)[0];
          speed += f[k] * flow.force_v(k)[0];
        }
        const Oscillator::Point end = oscillator.move({q, v}, {c0, c1 / t, c2 / (t * t)}, t);
        const double size = 1.0 + t + t * t;
        EXPECT_NEAR(end.q, x, kTight * size) << omega << " " << delta << " " << t;
        EXPECT_NEAR(end.v, speed, kTight * size * (1.0 + omega)) << omega << " " << delta << " " << t;
      }
  EXPECT_GT(moved, 30);
}

}  // namespace
}  // namespace butee::test::oscillator_test

#include <cmath>
#include <complex>

#include <butee/dynamics/contact_propagator.hpp>
#include <gtest/gtest.h>

namespace butee::test::modal_propagator_test {
namespace {

using Complex = std::complex<double>;
using dynamics::ModalHarmonic;
using dynamics::ModalPropagator;
using Eigen::ArrayXd;

/// Relative to the size of each quantity; a hundred times rounding, for up to twenty doublings.
constexpr double kTight = 1e-12;

ArrayXd array(std::initializer_list<double> values) {
  ArrayXd a(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), a.begin());
  return a;
}

/// Rigid, rigid with damping, slow, fast, damped, critical, overdamped.
const ArrayXd kOmega = array({0.0, 0.0, 1e-3, 4.0, 900.0, 7.0, 3.0, 2.0});
const ArrayXd kDelta = array({0.0, 0.5, 0.0, 0.1, 30.0, 7.0, 11.0, 400.0});
const std::vector<ModalHarmonic> kLoads = {{4.0, ArrayXd::Constant(8, 1.5), ArrayXd::Constant(8, -0.7)},
                                           {50.0, ArrayXd::LinSpaced(8, -1, 1), ArrayXd::Zero(8)}};

/// Fourth-order Runge-Kutta with very many steps: independent of the propagator's series and doublings.
struct State {
  double q, v;
};
template <class Force>
State integrate(double omega, double delta, double h, State s, Force force) {
  const int steps = 20 + static_cast<int>(1500.0 * (omega + delta + 50.0) * h);
  const double d = h / steps;
  const auto slope = [&](double t, State at) {
    return State{at.v, force(t) - 2.0 * delta * at.v - omega * omega * at.q};
  };
  for (int i = 0; i < steps; ++i) {
    const double t = i * d;
    const State k1 = slope(t, s), k2 = slope(t + d / 2, {s.q + d / 2 * k1.q, s.v + d / 2 * k1.v}),
                k3 = slope(t + d / 2, {s.q + d / 2 * k2.q, s.v + d / 2 * k2.v}),
                k4 = slope(t + d, {s.q + d * k3.q, s.v + d * k3.v});
    s.q += d / 6 * (k1.q + 2 * k2.q + 2 * k3.q + k4.q);
    s.v += d / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v);
  }
  return s;
}

TEST(ModalPropagator, AgreesWithManyRungeKuttaSteps) {
  // Fourth order with a step of (omega d) = 1/1500 leaves about 1e-12, plus the rounding of 1e5 additions.
  constexpr double kRungeKutta = 1e-10;
  const double h = 0.07, t = 0.31;
  ModalPropagator flow(kOmega, kDelta, kLoads, h);
  flow.refine(kOmega, kDelta);
  int checked = 0;
  for (Index i = 0; i < kOmega.size(); ++i) {
    const auto expect = [&](State computed, State expected, double scale) {
      EXPECT_NEAR(computed.q, expected.q, kRungeKutta * h * h * scale) << "mode " << i;
      EXPECT_NEAR(computed.v, expected.v, kRungeKutta * h * scale * std::max(1.0, kOmega[i] * h)) << "mode " << i;
      ++checked;
    };
    const auto none = [](double) { return 0.0; };
    expect({flow.qq()[i], flow.vq()[i]}, integrate(kOmega[i], kDelta[i], h, {1, 0}, none), 1.0 / (h * h));
    expect({flow.qv()[i], flow.vv()[i]}, integrate(kOmega[i], kDelta[i], h, {0, 1}, none), 1.0 / (h * h));
    for (int k = 0; k < 3; ++k) {
      const auto legendre = [&](double tau) {
        const double s = tau / h;
        return k == 0 ? 1.0 : k == 1 ? 2 * s - 1 : 6 * s * s - 6 * s + 1;
      };
      expect({flow.force_q(k)[i], flow.force_v(k)[i]}, integrate(kOmega[i], kDelta[i], h, {0, 0}, legendre), 1.0);
    }
    for (std::size_t j = 0; j < kLoads.size(); ++j) {
      const double w = kLoads[j].angular_frequency, c = std::cos(w * t), s = std::sin(w * t);
      const auto load = [&](double tau) {
        return kLoads[j].cosine[i] * std::cos(w * (t + tau)) + kLoads[j].sine[i] * std::sin(w * (t + tau));
      };
      expect({c * flow.harmonic_q(j, 0)[i] - s * flow.harmonic_q(j, 1)[i],
              c * flow.harmonic_v(j, 0)[i] - s * flow.harmonic_v(j, 1)[i]},
             integrate(kOmega[i], kDelta[i], h, {0, 0}, load), 2.0);
    }
  }
  EXPECT_EQ(checked, 8 * 7);
}

TEST(ModalPropagator, ALongStepIsManyShortOnes) {
  const double h = 1.0 / 256;
  ModalPropagator step(kOmega, kDelta, kLoads, h), whole(kOmega, kDelta, kLoads, 1.0);
  step.refine(kOmega, kDelta);
  whole.refine(kOmega, kDelta);
  ArrayXd q = ArrayXd::Constant(8, 0.3), v = ArrayXd::Constant(8, -0.2);
  const auto advance = [](const ModalPropagator& flow, double t, ArrayXd& x, ArrayXd& y) {
    ArrayXd next = flow.qq() * x + flow.qv() * y, speed = flow.vq() * x + flow.vv() * y;
    for (std::size_t j = 0; j < 2; ++j) {
      const double angle = flow.angular_frequencies()[j] * t;
      next += std::cos(angle) * flow.harmonic_q(j, 0) - std::sin(angle) * flow.harmonic_q(j, 1);
      speed += std::cos(angle) * flow.harmonic_v(j, 0) - std::sin(angle) * flow.harmonic_v(j, 1);
    }
    x = next;
    y = speed;
  };
  ArrayXd q_many = q, v_many = v;
  for (int i = 0; i < 256; ++i) advance(step, i * h, q_many, v_many);
  advance(whole, 0.0, q, v);
  for (Index i = 0; i < 8; ++i) {
    EXPECT_NEAR(q[i], q_many[i], kTight) << "mode " << i;
    EXPECT_NEAR(v[i], v_many[i], kTight * std::max(1.0, kOmega[i])) << "mode " << i;
  }
}

TEST(ModalPropagator, RefiningChangesNothingButRounding) {
  ModalPropagator flow(kOmega, kDelta, {}, 0.5), refined = flow;
  refined.refine(kOmega, kDelta);
  EXPECT_LT((flow.qq() - refined.qq()).abs().maxCoeff(), kTight);
  EXPECT_LT((flow.qv() - refined.qv()).abs().maxCoeff(), kTight);
  EXPECT_LT(((flow.vq() - refined.vq()) / (1.0 + kOmega)).abs().maxCoeff(), kTight);
  EXPECT_LT((flow.vv() - refined.vv()).abs().maxCoeff(), kTight);
}

/// The displacement of a stop by its own force, computed in two ways.
TEST(ContactPropagator, MobilitiesAreWhatAConstantForceDoes) {
  Eigen::MatrixXd shapes(8, 3);
  for (Index i = 0; i < 8; ++i)
    for (Index j = 0; j < 3; ++j) shapes(i, j) = std::cos(1.0 + static_cast<double>(3 * i + 2 * j));
  const dynamics::StopShapes stops(shapes);
  for (const double h : {1e-3, 0.4}) {
    dynamics::ContactPropagator flow(ModalPropagator(kOmega, kDelta, {}, h),
                                     ModalPropagator(kOmega, kDelta, {}, 0.5 * h), stops, kOmega, {});
    for (Index i = 0; i < 3; ++i) {
      const double own = flow.own_coupling(i)[0][0];
      EXPECT_GT(own, 0.0);
      EXPECT_NEAR(flow.mobilities()[i] / own, 1.0, kTight);
    }
  }
}

}  // namespace
}  // namespace butee::test::modal_propagator_test

// The responses of damped modes to harmonic loads, compared with Simpson's rule.
#include "integrators/exponential/harmonic_response.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "butee/core/types.hpp"

namespace butee::test::harmonic_response_test {
namespace {

/// The responses of modes to harmonic loads against Simpson's rule in 80 bit, each part by its own size: rigid motion,
/// a slow mode, decay, resonance, and lengths of all sizes.
TEST(HarmonicResponse, IsAccurateInBothPartsOfSlowAndResonantModes) {
  struct Case {
    double decay, turn, frequency, length;
  };
  const std::vector<Case> cases = {{0.0, 3e-8, 10.0, 1e-4}, {0.0, 3e-8, 10.0, 0.09}, {0.0, 3e-8, 10.0, 0.11},
                                   {0.0, 3e-8, 10.0, 2.0},  {0.0, 3e-8, -10.0, 2.0}, {0.0, 2.0, 30.0, 0.4},
                                   {-50.0, 0.0, 30.0, 0.4}, {-0.1, 30.0, 30.0, 0.5}, {-0.1, 30.0, -30.0, 0.5},
                                   {0.0, 30.0, 30.1, 0.02}, {-3.0, 40.0, 2.0, 0.3}};
  for (const Case& one : cases) {
    const long double a = one.decay, b = one.turn, omega = one.frequency, length = one.length;
    constexpr int kParts = 20000;
    std::array<long double, 4> wanted{}, sizes{};
    for (int i = 0; i <= kParts; ++i) {
      const long double tau = length * i / kParts, rest = length - tau, size = std::exp(a * rest),
                        weight = length / (3.0L * kParts) * (i == 0 || i == kParts ? 1 : 2 + 2 * (i % 2)),
                        re = size * std::cos(b * rest), im = size * std::sin(b * rest), c = std::cos(omega * tau),
                        s = std::sin(omega * tau);
      const std::array<long double, 4> terms = {re * c, im * c, re * s, im * s};
      for (std::size_t k = 0; k < 4; ++k) {
        wanted[k] += weight * terms[k];
        sizes[k] += weight * std::abs(terms[k]);
      }
    }
    using One = Eigen::Array<double, 1, 1>;
    const double size = std::exp(one.decay * one.length), angle = one.turn * one.length;
    const double turned = one.frequency * one.length;
    const integrators::HarmonicAngle<One> load{one.frequency, One(one.length), One(turned), One(std::cos(turned)),
                                               One(std::sin(turned))};
    const integrators::HarmonicResponse<One> got(load, One(one.decay), One(one.turn), One(size * std::cos(angle)),
                                                 One(size * std::sin(angle)));
    const std::array<double, 4> parts = {got.cosine_re[0], got.cosine_im[0], got.sine_re[0], got.sine_im[0]};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(parts[k], static_cast<double>(wanted[k]), 3e-14 * static_cast<double>(sizes[k]) + 1e-30)
          << k << ": " << one.decay << " " << one.turn << " " << one.frequency << " " << one.length;
    // Lanes of a step take series, resonance and closed form side by side.
    using Lane = Eigen::Array<double, 8, 1>;
    const Lane lengths = one.length * Lane{0.0, 1e-3, 1e-2, 0.1, 0.3, 0.5, 0.9, 1.0}, angles = one.frequency * lengths,
               decays = (one.decay * lengths).exp();
    const integrators::HarmonicAngle<Lane> loads{one.frequency, lengths, angles, angles.cos(), angles.sin()};
    const integrators::HarmonicResponse<Lane> lanes(loads, Lane::Constant(one.decay), Lane::Constant(one.turn),
                                                    decays * (one.turn * lengths).cos(),
                                                    decays * (one.turn * lengths).sin());
    for (Index lane = 0; lane < 8; ++lane) {
      const auto at = [lane](const Lane& all) { return One(all[lane]); };
      const integrators::HarmonicAngle<One> single{one.frequency, at(lengths), at(angles), at(loads.cosine),
                                                   at(loads.sine)};
      const integrators::HarmonicResponse<One> same(single, One(one.decay), One(one.turn),
                                                    at(decays * (one.turn * lengths).cos()),
                                                    at(decays * (one.turn * lengths).sin()));
      const double most = 1e-15 * lengths[lane];
      EXPECT_NEAR(lanes.cosine_re[lane], same.cosine_re[0], most);
      EXPECT_NEAR(lanes.cosine_im[lane], same.cosine_im[0], most);
      EXPECT_NEAR(lanes.sine_re[lane], same.sine_re[0], most);
      EXPECT_NEAR(lanes.sine_im[lane], same.sine_im[0], most);
    }
  }
}

}  // namespace
}  // namespace butee::test::harmonic_response_test

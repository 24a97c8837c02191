// Spectra compared with signals in closed form, and the thinning of curves.
#include "apps/butee/plot/spectrum.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "apps/butee/plot/motion.hpp"
#include "apps/butee/plot/scale.hpp"
#include "apps/butee/plot/thin.hpp"

namespace butee::test::spectrum_test {
namespace {

using namespace app::plot;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kRounding = 1e-12;

std::vector<double> times(std::size_t count, double dt) {
  std::vector<double> t(count);
  for (std::size_t i = 0; i < count; ++i) t[i] = dt * static_cast<double>(i);
  return t;
}

template <class Function>
std::vector<double> of(const std::vector<double>& t, Function&& f) {
  std::vector<double> x;
  for (const double at : t) x.push_back(f(at));
  return x;
}

TEST(Spectrum, ShowsTheAmplitudesOfCosinesAtTheirFrequencies) {
  // 1000 samples at 1 kHz: lines at whole Hz; the Hann window gives both neighbouring lines half the
  // amplitude.
  const auto t = times(1000, 1e-3);
  const auto x = of(t, [](double at) {
    return 5.0 + 3.0 * std::cos(kTwoPi * 50.0 * at + 0.4) + 0.01 * std::sin(kTwoPi * 120.0 * at);
  });
  const Spectrum spectrum = amplitude_spectrum(t, x);
  ASSERT_EQ(spectrum.frequencies.size(), 500U);
  EXPECT_NEAR(spectrum.frequencies[49], 50.0, kRounding * 50.0);
  EXPECT_NEAR(spectrum.amplitudes[49], 3.0, kRounding);
  EXPECT_NEAR(spectrum.amplitudes[48], 1.5, kRounding);
  EXPECT_NEAR(spectrum.amplitudes[119], 0.01, kRounding);
  EXPECT_NEAR(spectrum.amplitudes[0], 0.0, kRounding) << "the mean is not part of it";
  EXPECT_NEAR(spectrum.frequencies.back(), 500.0, kRounding * 500.0);
}

/// A history has a row at the end of the run, which may come early.
TEST(Spectrum, LeavesOutALastRowThatComesEarly) {
  auto t = times(1000, 1e-3);
  t.push_back(t.back() + 3e-4);
  const Spectrum spectrum = amplitude_spectrum(t, of(t, [](double at) { return std::cos(kTwoPi * 200.0 * at); }));
  ASSERT_EQ(spectrum.frequencies.size(), 500U);
  EXPECT_NEAR(spectrum.frequencies[199], 200.0, kRounding * 200.0);
  EXPECT_NEAR(spectrum.amplitudes[199], 1.0, kRounding);
}

TEST(Spectrum, CountsTheLineAtHalfTheSamplingRateOnce) {
  const auto t = times(64, 1.0 / 64.0);
  const Spectrum spectrum = amplitude_spectrum(t, of(t, [](double at) { return std::cos(kTwoPi * 32.0 * at); }));
  EXPECT_NEAR(spectrum.amplitudes.back(), 1.0, kRounding);
}

TEST(Spectrum, TakesUnevenTimes) {
  auto t = times(2001, 5e-4);
  for (std::size_t i = 1; i + 1 < t.size(); i += 2) t[i] += 1e-4;
  const Spectrum spectrum = amplitude_spectrum(t, of(t, [](double at) { return std::cos(kTwoPi * 20.0 * at); }));
  std::size_t top = 0;
  for (std::size_t i = 0; i < spectrum.amplitudes.size(); ++i)
    if (spectrum.amplitudes[i] > spectrum.amplitudes[top]) top = i;
  EXPECT_NEAR(spectrum.frequencies[top], 20.0, 0.02);
  EXPECT_NEAR(spectrum.amplitudes[top], 1.0, 2e-3);  // linear interpolation over 0.6 ms loses (w h)^2 / 8 at most
}

TEST(Spectrum, IsEmptyOfHardlyAnySamples) {
  EXPECT_TRUE(amplitude_spectrum({0.0, 1.0}, {1.0, 2.0}).frequencies.empty());
  EXPECT_TRUE(amplitude_spectrum({}, {}).frequencies.empty());
}

TEST(Thinning, KeepsEveryExtremeOfALongCurve) {
  const auto t = times(100001, 1e-5);
  auto x = of(t, [](double at) { return std::sin(kTwoPi * 700.0 * at); });
  x[54321] = 7.0;
  x[12345] = -9.0;
  const auto kept = thin(x);
  EXPECT_LT(kept.size(), 4000U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), 100000U);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 54321U), 1);
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 12345U), 1);
  EXPECT_EQ(thin({1.0, 2.0, 3.0}).size(), 3U);
}

TEST(Thinning, OfACurveInThePlaneStaysWithinThePen) {
  const auto t = times(200001, 1e-5);
  const auto x = of(t, [](double at) { return std::cos(kTwoPi * at); });
  const auto y = of(t, [](double at) { return std::sin(kTwoPi * at); });
  const auto kept = thin_path(x, y);
  EXPECT_LT(kept.size(), 20000U);
  for (std::size_t i = 1; i < kept.size(); ++i)
    EXPECT_LT(std::hypot(x[kept[i]] - x[kept[i - 1]], y[kept[i]] - y[kept[i - 1]]), 0.01);
}

TEST(Motion, MeetsAPeriodicMotionInOnePoint) {
  const auto t = times(1501, 1.3e-3);
  const double w = kTwoPi * 10.0;
  const auto u = of(t, [w](double at) { return std::cos(w * at - 0.3); });
  const auto v = of(t, [w](double at) { return -w * std::sin(w * at - 0.3); });
  const auto a = of(t, [w](double at) { return -w * w * std::cos(w * at - 0.3); });
  // Errors of the cubics: (w h)^4 / 384 in u, and in v without a (w h)^3 sqrt(3) / 216.
  constexpr double kCubic = 2e-7, kSlope = 6e-6;
  for (const auto* given : {&a, static_cast<const std::vector<double>*>(nullptr)}) {
    const auto points = Motion(t, u, v, given).once_per(0.1);
    ASSERT_EQ(points.size(), 20U);
    for (const auto& point : points) {
      EXPECT_NEAR(point.u, std::cos(0.3), kCubic);
      EXPECT_NEAR(point.v / w, std::sin(0.3), given != nullptr ? kCubic : kSlope);
    }
    for (const auto& point : Motion(t, u, v, given).smooth())
      EXPECT_NEAR(std::hypot(point.u, point.v / w), 1.0, given != nullptr ? 2 * kCubic : 2 * kSlope);
  }
}

TEST(Scale, GivesUnitsThatCanBeRead) {
  EXPECT_EQ(scale_for(0.0108, "m").unit, "mm");
  EXPECT_EQ(scale_for(1.0, "s").unit, "s");
  EXPECT_EQ(scale_for(1.0 - 1e-12, "s").unit, "s");
  EXPECT_EQ(scale_for(0.2, "s").unit, "ms");
  EXPECT_EQ(scale_for(858.0, "N").unit, "N");
  EXPECT_EQ(scale_for(2.5e4, "N").unit, "kN");
  EXPECT_EQ(scale_for(3e-5, "m").unit, "µm");
  EXPECT_EQ(scale_for(4000.0, "m").unit, "m");
  EXPECT_EQ(scale_for(0.0, "m").unit, "m");
  EXPECT_DOUBLE_EQ(scale_for(0.2, "s").factor, 1e3);
  EXPECT_EQ(scale_for(0.2, "s").axis("time"), "time / ms");
}

}  // namespace
}  // namespace butee::test::spectrum_test

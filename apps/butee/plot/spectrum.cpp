#include "spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace butee::app::plot {
namespace {

constexpr std::size_t kFewest = 8;

/// The signal at `count` evenly spaced times. The last row of a history may come early.
std::vector<double> resampled(const std::vector<double>& t, const std::vector<double>& x, double dt) {
  std::vector<double> even(t.size());
  std::size_t i = 0;
  for (std::size_t k = 0; k < even.size(); ++k) {
    const double at = std::min(t.front() + static_cast<double>(k) * dt, t.back());
    while (i + 2 < t.size() && t[i + 1] < at) ++i;
    const double width = t[i + 1] - t[i];
    const double part = width > 0.0 ? (at - t[i]) / width : 0.0;
    even[k] = x[i] + part * (x[i + 1] - x[i]);
  }
  return even;
}

}  // namespace

Spectrum amplitude_spectrum(const std::vector<double>& times, const std::vector<double>& values) {
  const std::size_t n = times.size();
  if (n < kFewest || !(times.back() > times.front())) return {};
  const double dt = (times.back() - times.front()) / static_cast<double>(n - 1);
  std::vector<double> signal = resampled(times, values, dt);
  double mean = 0.0, sum = 0.0;
  for (const double value : signal) mean += value / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
    signal[i] = w * (signal[i] - mean);
    sum += w;
  }
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, signal);
  Spectrum spectrum;
  for (std::size_t k = 1; k <= n / 2; ++k) {
    spectrum.frequencies.push_back(static_cast<double>(k) / (static_cast<double>(n) * dt));
    spectrum.amplitudes.push_back(2.0 * std::abs(lines[k]) / sum);
  }
  return spectrum;
}

}  // namespace butee::app::plot

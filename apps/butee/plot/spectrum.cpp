#include "spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace butee::app::plot {
namespace {

constexpr std::size_t kFewest = 8;

/// Resamples the signal linearly at `count` evenly spaced times.
std::vector<double> resampled(const std::vector<double>& t, const std::vector<double>& x, double dt,
                              std::size_t count) {
  std::vector<double> even(count);
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

/// The number of samples at equal distances: all but the last if only that comes early, at the end of a run.
std::size_t regular(const std::vector<double>& t) {
  constexpr double kEqual = 1e-6;
  const std::size_t n = t.size();
  const double dt = t[1] - t[0];
  for (std::size_t i = 1; i + 2 < n; ++i)
    if (std::abs(t[i + 1] - t[i] - dt) > kEqual * dt) return n;
  return t[n - 1] - t[n - 2] < (1.0 - kEqual) * dt ? n - 1 : n;
}

/// The Fourier transform of y + i z (or of y alone), minus its mean, under a Hann window; `sum` receives the
/// sum of the window's values. Empty for too few samples. `dt` receives the time between two samples, s.
std::vector<std::complex<double>> transformed(const std::vector<double>& times, const std::vector<double>& y,
                                              const std::vector<double>& z, double& sum, double& dt) {
  if (times.size() < kFewest || !(times.back() > times.front())) return {};
  const std::size_t n = regular(times);
  dt = (times[n - 1] - times.front()) / static_cast<double>(n - 1);
  const std::vector<double> real = resampled(times, y, dt, n);
  const std::vector<double> imaginary = z.empty() ? std::vector<double>(n, 0.0) : resampled(times, z, dt, n);
  std::vector<std::complex<double>> signal(n), lines;
  std::complex<double> mean = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    signal[i] = {real[i], imaginary[i]};
    mean += signal[i] / static_cast<double>(n);
  }
  sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
    signal[i] = w * (signal[i] - mean);
    sum += w;
  }
  Eigen::FFT<double> transform;
  transform.fwd(lines, signal);
  return lines;
}

}  // namespace

Spectrum amplitude_spectrum(const std::vector<double>& times, const std::vector<double>& values) {
  double sum = 0.0, dt = 0.0;
  const auto lines = transformed(times, values, {}, sum, dt);
  Spectrum spectrum;
  for (std::size_t k = 1; k < lines.size() && k <= lines.size() / 2; ++k) {
    spectrum.frequencies.push_back(static_cast<double>(k) / (static_cast<double>(lines.size()) * dt));
    // The line at half the sampling rate is its own mirror image.
    spectrum.amplitudes.push_back((2 * k == lines.size() ? 1.0 : 2.0) * std::abs(lines[k]) / sum);
  }
  return spectrum;
}

Spectrum full_spectrum(const std::vector<double>& times, const std::vector<double>& y, const std::vector<double>& z) {
  double sum = 0.0, dt = 0.0;
  const auto lines = transformed(times, y, z, sum, dt);
  const auto n = static_cast<std::ptrdiff_t>(lines.size());
  Spectrum spectrum;
  for (std::ptrdiff_t k = -(n - 1) / 2; k <= n / 2 && n > 0; ++k) {
    spectrum.frequencies.push_back(static_cast<double>(k) / (static_cast<double>(n) * dt));
    spectrum.amplitudes.push_back(std::abs(lines[static_cast<std::size_t>(k < 0 ? k + n : k)]) / sum);
  }
  return spectrum;
}

}  // namespace butee::app::plot

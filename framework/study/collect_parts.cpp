#include "butee/study/collect_parts.hpp"

#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "butee/record/quadrature.hpp"

namespace butee::study {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// Samples of a spectrum: for each period, at least and at most.
constexpr double kSamplesPerPeriod = 64.0, kFewestSamples = 4096.0, kMostSamples = 262144.0;

/// The frequency of the largest line, between lines by a parabola through the logarithms of three (Hann's window).
double dominant_frequency(std::vector<double> signal, double dt) {
  const auto n = static_cast<double>(signal.size());
  double mean = 0.0;
  for (const double value : signal) mean += value / n;
  for (std::size_t i = 0; i < signal.size(); ++i)
    signal[i] = (signal[i] - mean) * (0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / n));
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, signal);
  std::size_t best = 1;
  for (std::size_t k = 2; k + 1 <= signal.size() / 2; ++k)
    if (std::norm(lines[k]) > std::norm(lines[best])) best = k;
  const double a = std::abs(lines[best - 1]), b = std::abs(lines[best]), c = std::abs(lines[best + 1]);
  if (!(b > 0.0)) return kNothing;
  double offset = 0.0;
  if (best > 1 && a > 0.0 && c > 0.0) offset = 0.5 * std::log(a / c) / std::log(a * c / (b * b));
  return (static_cast<double>(best) + offset) / (n * dt);
}

}  // namespace

void MeanPart::step(const time::AcceptedStep& step) {
  times_.clear();
  weights_.clear();
  double begin = step.from.t;
  const auto piece = [&](double end) {
    for (const auto& [t, weight] : record::gauss_points(begin, end)) {
      times_.push_back(t);
      weights_.push_back(weight);
    }
    begin = end;
  };
  for (const double knot : step.integrator.knots(step.from, step.to)) piece(knot);
  piece(step.to.t);
  times_.push_back(step.to.t);
  weights_.push_back(0.0);
  probes_.sample(step, times_);
  for (std::size_t k = 0; k < times_.size(); ++k) {
    probes_.take(k, row_);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      sums_[i] += weights_[k] * row_[i];
      squares_[i] += weights_[k] * row_[i] * row_[i];
      largest_[i] = std::max(largest_[i], std::abs(row_[i]));
    }
  }
  last_ = row_;
}
FrequencyPart::FrequencyPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics,
                             const Counted& counted)
    : probes_(probes, dynamics), counted_(counted), row_(probes.size()), values_(probes.size()) {
  const double wanted =
      std::clamp(kSamplesPerPeriod * static_cast<double>(counted.periods), kFewestSamples, kMostSamples);
  count_ = std::int64_t{1} << static_cast<int>(std::ceil(std::log2(wanted)));
  dt_ = (counted.end - counted.begin) / static_cast<double>(count_);
}

std::vector<double> FrequencyPart::values(std::size_t item) const {
  if (taken_ < count_) return {kNothing};
  return {dominant_frequency(values_[item], dt_)};
}

}  // namespace butee::study

#include "butee/study/collect_parts.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "butee/core/quadrature.hpp"

namespace butee::study {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
/// Samples of a spectrum: per period, at least and at most.
constexpr double kSamplesPerPeriod = 64.0, kFewestSamples = 4096.0, kMostSamples = 262144.0;

/// Tolerance for the change of an integral of squares by halving an interval, and the largest
/// number of halvings.
constexpr double kGoodMean = 1e-9;
constexpr int kMostHalvings = 12;

/// The frequency of the largest line, interpolated by a parabola through the logarithms of three
/// lines (Hann window).
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

model::OutputRequest rows_of(const std::vector<model::ProbeRequest>& probes, const Counted& counted) {
  model::OutputRequest request;
  const double fewest =
      counted.period > 0.0 ? counted.period / kSamplesPerPeriod : (counted.end - counted.begin) / kFewestSamples;
  request.interval = std::min(fewest, counted.interval);
  request.probes = probes;
  return request;
}

}  // namespace

SampledPeakPart::SampledPeakPart(const std::vector<model::ProbeRequest>& probes, dynamics::Dynamics& dynamics,
                                 const Counted& counted)
    : history_(rows_of(probes, counted), std::numeric_limits<double>::infinity(), dynamics, nullptr) {
  for (const model::ProbeRequest& probe : probes) names_.push_back(probe.label + "." + name_of(probe.quantities[0]));
}

MeanPart::Integral MeanPart::integrate(const time::AcceptedStep& step, double begin, double end) {
  const auto points = gauss_points(begin, end);
  std::array<double, points.size()> times{};
  for (std::size_t k = 0; k < points.size(); ++k) times[k] = points[k].t;
  Integral result{std::vector<double>(row_.size()), std::vector<double>(row_.size())};
  probes_.sample(step, times);
  for (std::size_t k = 0; k < points.size(); ++k) {
    probes_.take(k, row_);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      result.sums[i] += points[k].weight * row_[i];
      result.squares[i] += points[k].weight * row_[i] * row_[i];
    }
  }
  return result;
}

bool MeanPart::are_same(const Integral& a, const Integral& b, double length) const {
  for (std::size_t i = 0; i < row_.size(); ++i) {
    const double square = total_.squares[i] + b.squares[i];
    if (std::abs(a.squares[i] - b.squares[i]) > kGoodMean * square) return false;
    if (std::abs(a.sums[i] - b.sums[i]) > kGoodMean * std::sqrt(length * square)) return false;
  }
  return true;
}

void MeanPart::add(const time::AcceptedStep& step, double begin, double end, const Integral& whole, int halvings) {
  const auto take = [&](const Integral& integral) {
    for (std::size_t i = 0; i < row_.size(); ++i) {
      total_.sums[i] += integral.sums[i];
      total_.squares[i] += integral.squares[i];
    }
  };
  if (step.motion.interpolation() != time::Interpolation::other || halvings == kMostHalvings) return take(whole);
  const double middle = 0.5 * (begin + end);
  const Integral first = integrate(step, begin, middle), second = integrate(step, middle, end);
  Integral both = first;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    both.sums[i] += second.sums[i];
    both.squares[i] += second.squares[i];
  }
  if (are_same(whole, both, end - begin)) return take(both);
  add(step, begin, middle, first, halvings + 1);
  add(step, middle, end, second, halvings + 1);
}

void MeanPart::step(const time::AcceptedStep& step) {
  double begin = step.from.t;
  const auto piece = [&](double end) {
    const double parts = std::max(1.0, std::ceil((end - begin) / longest_)), length = (end - begin) / parts;
    for (double k = 0.0; k < parts; k += 1.0)
      add(step, begin + k * length, begin + (k + 1.0) * length,
          integrate(step, begin + k * length, begin + (k + 1.0) * length), 0);
    begin = end;
  };
  for (const double breakpoint : step.motion.breakpoints(time::Detail::accelerations)) piece(breakpoint);
  piece(step.to.t);
  probes_.evaluate(step, step.to.t, last_);
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

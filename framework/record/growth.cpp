#include "butee/record/growth.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace butee::record {
namespace {

constexpr std::size_t kParts = 8;
constexpr double kFewest = 4.0;                   ///< instants in a part
constexpr double kLeastRise = 2.995732273553991;  // ln 20
constexpr double kStandardErrors = 2.5;

struct Line {
  double slope, squares;  ///< squares: sum of squared distances
};

Line fit(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xy / xx;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double distance = y[i] - mean_y - slope * (x[i] - mean_x);
    squares += distance * distance;
  }
  return {slope, squares};
}

}  // namespace

double Growth::log_between(double t) const {
  double least = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < times.size() && (i == 0 || times[i - 1] < t); ++i) {
    least = std::min(least, logs[i]);
    largest = std::max(largest, logs[i] - least);
  }
  return largest;
}

double Growth::amplification() const {
  const double largest =
      displacement_logs.empty() ? 0.0 : *std::max_element(displacement_logs.begin(), displacement_logs.end());
  return std::max(displaced, std::exp(std::clamp(largest, 0.0, 700.0)));
}

Growth::Rate Growth::exponential() const {
  if (times.empty()) return {};
  if (const double rate = rate_until(times.back()); rate > 0.0) return {rate, times.back()};
  const double high = *std::max_element(logs.begin(), logs.end()) - 1.0;
  const auto first = std::find_if(logs.begin(), logs.end(), [&](double log) { return log >= high; });
  const double until = times[static_cast<std::size_t>(first - logs.begin())], rate = rate_until(until);
  return {rate, rate > 0.0 ? until : 0.0};
}

double Growth::rate_until(double end) const {
  if (!(end > 0.0)) return 0.0;
  std::array<double, kParts> sum{}, t_sum{}, count{};
  for (std::size_t i = 0; i < times.size() && times[i] <= end; ++i) {
    const auto part = std::min(kParts - 1, static_cast<std::size_t>(times[i] / end * double(kParts)));
    sum[part] += logs[i];
    t_sum[part] += times[i];
    count[part] += 1.0;
  }
  std::vector<double> t, log_t, y;
  for (std::size_t part = 1; part < kParts; ++part) {
    if (count[part] < kFewest) return 0.0;
    t.push_back(t_sum[part] / count[part]);
    log_t.push_back(std::log(t.back()));
    y.push_back(sum[part] / count[part]);
  }
  const double increments = static_cast<double>(y.size() - 1), rise = y.back() - y.front(), mean = rise / increments;
  double variance = 0.0;
  for (std::size_t i = 1; i < y.size(); ++i) variance += std::pow(y[i] - y[i - 1] - mean, 2) / (increments - 1.0);
  if (!(rise > kLeastRise) || mean < kStandardErrors * std::sqrt(variance / increments)) return 0.0;
  const Line in_t = fit(t, y), in_log = fit(log_t, y);
  return in_t.squares < in_log.squares ? in_t.slope : 0.0;
}

}  // namespace butee::record

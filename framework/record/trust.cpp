#include "butee/record/trust.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "butee/core/text.hpp"

namespace butee::record {
namespace {

constexpr double kOfExact = 1.5, kOfAnother = 3.0, kOfNone = 10.0, kOfNoise = 3.0;
/// A bound of this size or more is meaningless.
constexpr double kMeaningless = 1.0;
constexpr double kRoundings = 4.0 * std::numeric_limits<double>::epsilon();

/// The peak of each history, but at least kLeastOfKind of the largest of its kind in the structure.
std::vector<double> scales_of(const Histories& histories) {
  constexpr double kLeastOfKind = 1e-3;
  std::vector<double> scales;
  std::array<double, 3> largest = histories.largest_of_kind;
  const auto kind = [&](std::size_t i) {
    return i < histories.kinds.size() ? histories.kinds[i] : Histories::displacement;
  };
  for (std::size_t i = 0; i < histories.values.size(); ++i) {
    double peak = 0.0;
    for (const double value : histories.values[i]) peak = std::max(peak, std::abs(value));
    scales.push_back(peak);
    largest[kind(i)] = std::max(largest[kind(i)], peak);
  }
  for (std::size_t i = 0; i < scales.size(); ++i) scales[i] = std::max(scales[i], kLeastOfKind * largest[kind(i)]);
  return scales;
}

/// The largest difference over the probes at instant i, relative to the scales; infinite if one of the runs did not
/// reach it.
double difference_at(const Histories& a, const Histories& b, std::size_t i, const std::vector<double>& scales) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (a.times.empty() || b.times.empty()) return 0.0;
  double largest = 0.0;
  for (std::size_t probe = 0; probe < a.values.size(); ++probe) {
    if (i >= a.values[probe].size() || i >= b.values[probe].size()) return kInfinite;
    const double difference = std::abs(a.values[probe][i] - b.values[probe][i]);
    if (std::isnan(difference) || (difference > 0.0 && scales[probe] == 0.0)) return kInfinite;
    if (difference > 0.0) largest = std::max(largest, difference / scales[probe]);
  }
  return largest;
}

double factor_of(const TrustRuns& runs) {
  if (runs.other.times.empty()) return kOfNone;
  return runs.is_exact ? kOfExact : kOfAnother;
}

}  // namespace

Trust judge(const TrustRuns& runs, double accuracy) {
  Trust trust;
  trust.accuracy = accuracy;
  const std::vector<double>& times = runs.run.times;
  trust.end = times.empty() ? 0.0 : times.back();
  const std::vector<double> scales = scales_of(runs.run);
  const double factor = factor_of(runs);
  const auto moves_in = [](const Histories& histories) {
    const std::vector<double> largest = scales_of(histories);
    return std::any_of(largest.begin(), largest.end(), [](double scale) { return scale > 0.0; });
  };
  const bool moves = moves_in(runs.run) || moves_in(runs.tightened) || moves_in(runs.other);
  const Growth& growth = runs.growth;
  double difference = 0.0, noise = 0.0, log_growth = 0.0;
  std::size_t looked = 0;
  trust.to_the_end = true;
  for (std::size_t i = 0; i < times.size(); ++i) {
    difference = std::max({difference, difference_at(runs.run, runs.tightened, i, scales),
                           difference_at(runs.run, runs.other, i, scales)});
    noise = std::max(noise, difference_at(runs.other, runs.again, i, scales));
    if (looked < growth.times.size() && growth.times[looked] <= times[i]) {
      log_growth = growth.log_between(times[i]);
      while (looked < growth.times.size() && growth.times[looked] <= times[i]) ++looked;
    }
    const double rounding = kRoundings * (1.0 + growth.omega * times[i]) * std::exp(std::min(log_growth, 700.0));
    const double bound = moves ? factor * difference + kOfNoise * std::max(noise, rounding) : 0.0;
    trust.end_bound = bound;
    trust.to_the_end = trust.to_the_end && bound <= accuracy;
    if (!trust.to_the_end) continue;
    trust.difference = difference;
    trust.bound = bound;
    trust.horizon = times[i];
  }
  const auto [rate, until] = growth.exponential();
  trust.growth_rate = rate;
  trust.growth_until = until;
  trust.chaotic = trust.growth_rate > 0.0;
  trust.amplification = growth.amplification();
  return trust;
}

double largest_difference(const Histories& a, const Histories& b) {
  double largest = 0.0;
  for (std::size_t probe = 0; probe < a.values.size(); ++probe)
    for (std::size_t i = 0; i < std::min(a.values[probe].size(), b.values[probe].size()); ++i)
      largest = std::max(largest, std::abs(a.values[probe][i] - b.values[probe][i]));
  return largest;
}

Trust::Statistic bracket(const std::string& name, const std::vector<double>& values, bool is_count, double factor,
                         double floor) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double value = values.front();
  if (is_count) return {name, value, *least, *greatest, true};
  const double margin = std::max(factor * (*greatest - *least), floor);
  return {name, value, std::max(0.0, value - margin), value + margin, false};
}

namespace {

/// "0.001144851235 +- 3.5e-11", "23 in all runs"; an interval that zero cuts off: "1e-9, between 0 and 3e-9".
std::string interval_of(const Trust::Statistic& s) {
  const std::string range = ", between " + to_short_text(s.least) + " and " + to_short_text(s.greatest);
  if (s.is_count) return to_short_text(s.value) + (s.least < s.greatest ? range : "") + " in all runs";
  const double margin = s.greatest - s.value;
  if (!(margin > 0.0) || !std::isfinite(margin) || !(s.least > 0.0)) return to_short_text(s.value) + range;
  // As many digits as have meaning, two of them uncertain; the margin covers the rounding of both numbers.
  constexpr double kOfRounding = 1.1;
  const int digits = static_cast<int>(std::ceil(std::log10(s.value / margin))) + 2;
  return to_short_text(s.value, std::clamp(digits, 6, 15)) + " +- " + to_short_text(kOfRounding * margin, 2);
}

}  // namespace

std::string describe(const Trust& trust) {
  if (trust.statistics.empty())
    return "  trust: nothing is judged, since the scene requests no quantity; add an [[output.probe]]\n";
  std::vector<std::string> beside;
  if (!trust.other.empty()) beside.push_back("a run by " + trust.other);
  if (!trust.tightened.empty()) beside.push_back("one with " + trust.tightened);
  std::string text = "  trust: compared with " + (beside.empty() ? "no other run" : join(beside, " and ")) +
                     ", the error of the probes' displacements and rotations is ";
  const std::string accuracy = to_short_text(trust.accuracy) + " of the peak";
  const bool is_bounded = trust.to_the_end || trust.end_bound < kMeaningless;
  if (trust.to_the_end)
    text += "at most " + to_short_text(trust.bound) + " of the peak to the end, within the " +
            to_short_text(trust.accuracy) + " demanded (trust_accuracy)";
  else
    text += "at most " + accuracy + " up to t = " + to_short_text(trust.horizon) +
            " s: the run is accurate up to that time" +
            (is_bounded ? "; to the end it is at most " + to_short_text(trust.end_bound) : "");
  text += trust.chaotic
              ? "\n  trust: small differences grow like e^(" + to_short_text(trust.growth_rate) + " t)" +
                    (trust.growth_until < trust.end ? " up to t = " + to_short_text(trust.growth_until) + " s" : "") +
                    ", by " + to_short_text(trust.amplification) + " in all" +
                    (is_bounded ? "" : ": beyond the horizon the motion cannot be predicted") + "; reliable results:"
              : "\n  trust: small differences grew at most " + to_short_text(trust.amplification) +
                    " times; reliable results:";
  text += "\n";
  for (const Trust::Statistic& s : trust.statistics) text += "  trust: " + s.name + " = " + interval_of(s) + "\n";
  return text;
}

}  // namespace butee::record

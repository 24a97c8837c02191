#include "butee/record/trust.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/text.hpp"

namespace butee::record {
namespace {

/// Differences beyond this fraction of the peak no longer grow freely.
constexpr double kSaturated = 3e-2;
/// Growth by less than this before the end is not called chaos.
constexpr double kChaoticGrowth = 1e4;

double peak_of(const Courses& courses) {
  double peak = 0.0;
  for (const auto& course : courses.values)
    for (const double value : course) peak = std::max(peak, std::abs(value));
  return peak;
}

/// The largest difference over the probes at instant i.
double difference_at(const Courses& a, const Courses& b, std::size_t i) {
  double largest = 0.0;
  for (std::size_t probe = 0; probe < a.values.size(); ++probe)
    largest = std::max(largest, std::abs(a.values[probe][i] - b.values[probe][i]));
  return largest;
}

std::size_t common_size(const Courses& a, const Courses& b) {
  std::size_t size = a.times.size();
  for (const Courses* courses : {&a, &b})
    for (const auto& course : courses->values) size = std::min(size, course.size());
  return size;
}

void find_horizon(const Courses& run, const Courses& tightened, double peak, Trust& trust) {
  const std::size_t size = common_size(run, tightened);
  std::size_t i = 0;
  for (; i < size; ++i) {
    const double difference = difference_at(run, tightened, i);
    if (!(difference <= trust.accuracy * peak)) break;
    trust.difference = std::max(trust.difference, peak > 0.0 ? difference / peak : 0.0);
  }
  trust.to_the_end = i == run.times.size();
  trust.horizon = i > 0 ? run.times[i - 1] : 0.0;
}

/// The slope of the straight line through ln(difference) until it saturates, 1/s. The envelope is taken, the largest
/// difference so far, since a difference passes through zero wherever two motions cross.
double fit_growth(const Courses& run, const Courses& other, double peak) {
  double sum = 0.0, t_sum = 0.0, y_sum = 0.0, tt = 0.0, ty = 0.0, envelope = 0.0;
  const std::size_t size = common_size(run, other);
  for (std::size_t i = 1; i < size; ++i) {
    envelope = std::max(envelope, difference_at(run, other, i));
    if (envelope > kSaturated * peak) break;
    if (!(envelope > 0.0)) continue;
    const double t = run.times[i], y = std::log(envelope);
    sum += 1.0;
    t_sum += t;
    y_sum += y;
    tt += t * t;
    ty += t * y;
  }
  const double spread = sum * tt - t_sum * t_sum;
  if (sum < 3.0 || !(spread > 0.0)) return 0.0;
  return (sum * ty - t_sum * y_sum) / spread;
}

}  // namespace

Trust judge(const Courses& run, const Courses& tightened, const std::array<Courses, 2>& perturbed, double perturbation,
            double accuracy) {
  Trust trust;
  trust.accuracy = accuracy;
  const double peak = peak_of(run);
  find_horizon(run, tightened, peak, trust);
  const auto& [one, other] = perturbed;
  trust.growth_rate = fit_growth(one, other, peak);
  for (std::size_t i = 0; i < common_size(one, other); ++i)
    trust.amplification = std::max(trust.amplification, difference_at(one, other, i) / (2.0 * perturbation));
  trust.chaotic = trust.growth_rate * run.times.back() > std::log(kChaoticGrowth);
  return trust;
}

std::string describe(const Trust& trust) {
  std::string text = "  trust: with " + trust.tightened + " the probes ";
  const std::string accuracy = to_short_text(trust.accuracy) + " of the peak";
  if (trust.to_the_end)
    text += "stay within " + to_short_text(trust.difference) + " of the peak to the end: the run stands to " + accuracy;
  else
    text += "leave " + accuracy + " after t = " + to_short_text(trust.horizon) + " s: up to there the run stands";
  text += trust.chaotic ? "\n  trust: small differences grow like e^(" + to_short_text(trust.growth_rate) +
                              " t): beyond its horizon no run tells the course of this scene; what does hold:"
                        : "\n  trust: small differences grow no more than " + to_short_text(trust.amplification) +
                              " times; what differs between the runs:";
  text += "\n";
  for (const Trust::Statistic& s : trust.statistics)
    text += "  trust: " + s.name + " = " + to_short_text(s.value) + ", between " + to_short_text(s.least) + " and " +
            to_short_text(s.greatest) + " in all runs\n";
  return text;
}

}  // namespace butee::record

#include "analysis.hpp"

#include <cmath>
#include <numbers>

#include <butee/linalg/general_pairs.hpp>

namespace butee::app::stability {
namespace {

constexpr double kSmallestStep = 1e-3;
constexpr int kPerDecade = 20;
/// Sampling of the drawn curves; fine enough for their slope discontinuity at the stability limit.
constexpr int kDrawnPerDecade = 60;
constexpr int kBisections = 60;
/// Range of the drawn steps, h omega.
constexpr double kFirstDrawn = 1e-2, kLastDrawn = 1e2;
/// Imaginary parts below this fraction of |lambda| are rounding: merging eigenvalues are accurate only to the
/// square root of the machine precision.
constexpr double kReal = 1e-7;

/// NaN if the eigenvalue computation failed.
Eigen::Vector3cd eigenvalues_of(const Eigen::Matrix3d& map) {
  const auto values = linalg::eigenvalues(map);
  if (!values) return Eigen::Vector3cd::Constant(std::numeric_limits<double>::quiet_NaN());
  return *values;
}

double radius_of(const Eigen::Matrix3d& map) {
  return eigenvalues_of(map).cwiseAbs().maxCoeff();
}

enum class Verdict { stable, unstable, no_map };

Verdict judge(OneStepMap& map, double h) {
  const auto matrix = map.at(h);
  if (!matrix) return Verdict::no_map;
  return radius_of(*matrix) <= 1.0 + kStable + kRounding * matrix->norm() ? Verdict::stable : Verdict::unstable;
}

double at_point(int i) {
  return kSmallestStep * std::pow(10.0, static_cast<double>(i) / kPerDecade);
}

void sample(OneStepMap& map, double ratio, double stop_ratio, std::vector<Sample>& samples) {
  const int count = static_cast<int>(std::lround(std::log10(kLastDrawn / kFirstDrawn) * kDrawnPerDecade));
  for (int i = 0; i <= count; ++i) {
    const double h = kFirstDrawn * std::pow(10.0, static_cast<double>(i) / kDrawnPerDecade);
    Sample one{h, ratio, stop_ratio, {}};
    if (const auto matrix = map.at(h)) one.properties = properties_of(*matrix, h * std::sqrt(1.0 + stop_ratio), ratio);
    samples.push_back(one);
  }
}

}  // namespace

Properties properties_of(const Eigen::Matrix3d& map, double h_omega, double ratio) {
  Properties properties;
  const Eigen::Vector3cd values = eigenvalues_of(map);
  properties.radius = values.cwiseAbs().maxCoeff();
  const std::complex<double>* principal = nullptr;
  for (const auto& value : values)
    if (value.imag() > kReal * std::abs(value) && (principal == nullptr || std::abs(value) > std::abs(*principal)))
      principal = &value;
  if (principal == nullptr || ratio >= 1.0) return properties;
  const double turn = std::arg(*principal), loss = -std::log(std::abs(*principal));
  properties.damping = loss / std::hypot(turn, loss) - ratio;
  const double true_turn = h_omega * std::sqrt(1.0 - ratio * ratio);
  if (true_turn < std::numbers::pi) properties.period_error = true_turn / turn - 1.0;
  return properties;
}

Limit find_limit(OneStepMap& map) {
  double stable = 0.0;
  for (int i = 0; at_point(i) <= kLargestStep * (1.0 + kStable); ++i) {
    const double h = at_point(i);
    const Verdict verdict = judge(map, h);
    if (verdict == Verdict::stable) {
      stable = h;
      continue;
    }
    double bad = h;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (stable + bad);
      (judge(map, middle) == Verdict::stable ? stable : bad) = middle;
    }
    // At the end of the stable steps, either the map becomes unstable or it ceases to exist.
    const bool has_map = judge(map, bad) == Verdict::unstable;
    return {has_map ? Limit::Kind::found : Limit::Kind::no_map, stable, has_map ? "" : map.refusal()};
  }
  return {Limit::Kind::unbounded, kLargestStep, ""};
}

Analysis analyse(const plugin::Catalogue& catalogue, const std::string& method, const Request& request) {
  const auto map_of = [&](const Oscillator& oscillator) {
    return OneStepMap(catalogue, method, request.settings, oscillator);
  };
  OneStepMap undamped = map_of({}), dashpot = map_of({0.0, 1.0, 0.0});
  Analysis analysis{undamped.type().name,
                    undamped.parameters(),
                    undamped.choice(),
                    undamped.type().stability_limit,
                    undamped.type().damping_limit,
                    find_limit(undamped),
                    find_limit(dashpot),
                    {},
                    {},
                    {},
                    {}};
  if (!analysis.has_map()) return analysis;
  for (const double ratio : request.ratios) {
    OneStepMap map = map_of({1.0, 2.0 * ratio, 0.0});
    analysis.damped.push_back(find_limit(map));
    sample(map, ratio, 0.0, analysis.curves);
  }
  for (const double stop : request.stop_ratios) {
    OneStepMap map = map_of({1.0, 0.0, stop});
    analysis.with_stop.push_back(find_limit(map));
    sample(map, 0.0, stop, analysis.stops);
  }
  return analysis;
}

}  // namespace butee::app::stability

#include "trust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/record/extremes.hpp>

#include "perturb.hpp"
#include "trust/disturbance.hpp"
#include "trust/other_family.hpp"

namespace butee::app {
namespace {

using namespace trust;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Relative to the peak: a start that differs by rounding.
constexpr double kRounding = 1e-16;
/// Relative to the motion: disturbances are so many times the noise of a step, and so large at least and at most.
constexpr double kAboveNoise = 1e4, kSmallest = 1e-8, kLargest = 1e-3;
/// Relative to the peak: starts of further runs of a chaotic scene.
constexpr double kElsewhere = 1e-6;
/// By how much of the range of the runs a number may lie beside the judged run's: 1.5 as rows (record::judge), where
/// they agree; where they do not, five runs are a sample of which a 99 % prediction interval has 4.6 sqrt(6/5) standard
/// deviations to each side, 2.2 of its expected range.
constexpr double kAgreeing = 1.5, kScattering = 2.2;
constexpr double kFinestTolerance = 1e-12;
constexpr Wanted kNumbers = {.states = false, .numbers = true, .impacts = true};

/// The scene with half the step, a tenth of the tolerance, or what the method has instead; nothing where it has
/// nothing.
std::optional<scene::Scene> tighten(const scene::Scene& session, std::string& what) {
  plugin::Catalogue catalogue = session.catalogue;
  const time::IntegratorType& type = catalogue.load(session.integrator.name);
  const double step = session.integrator.options.time_step;
  const auto swept = std::find_if(type.parameters.begin(), type.parameters.end(),
                                  [](const config::Parameter& parameter) { return parameter.swept.has_value(); });
  std::string key = "time_step";
  double before = step, after = 0.5 * step;
  if (!type.fixed_step && swept != type.parameters.end()) {
    key = swept->name;
    before = session.integrator.parameters.number(key);
    after = 0.1 * before;
    if (after < std::min(kFinestTolerance, swept->swept->second)) return std::nullopt;
  } else if (!(step > 0.0)) {
    return std::nullopt;
  }
  what = key + " " + to_short_text(before) + " -> " + to_short_text(after);
  config::Document document = session.document;
  (*(*document.root.table())["integrator"].table())[key] = config::Value(after);
  try {
    return scene::read_scene(std::move(document), std::move(catalogue));
  } catch (const InputError&) {
    return std::nullopt;  // it is as tight as it can be
  }
}

/// The method that integrates: what `auto` chose, or the scene's.
std::string method_of(const scene::Scene& session, const FollowedRun& run) {
  return run.choice.empty() ? session.integrator.name : run.choice.substr(0, run.choice.find_first_of(" :"));
}

/// Methods without truncation error.
bool is_closed_form(const std::string& method) {
  return method == "exact" || method == "piecewise";
}

double tolerance_of(const scene::Scene& session, const std::string& method) {
  const config::Parameters& parameters = session.integrator.parameters;
  return session.integrator.options.limits.keeps_tolerance && !is_closed_form(method) && parameters.has("tolerance")
             ? parameters.number("tolerance")
             : 0.0;
}

double peak_of(const FollowedRun& run) {
  double peak = 0.0;
  for (const auto& history : run.histories.values)
    for (const double value : history) peak = std::max(peak, std::abs(value));
  return peak;
}

/// The largest entry of the disturbance of a start, relative to its size.
double largest_perturbation(Index size) {
  Vector x = Vector::Zero(size);
  perturb(x, 1.0);
  return x.lpNorm<Eigen::Infinity>();
}

FollowedRun follow_or_throw(scene::Scene& session, double disturbance, Wanted wanted) {
  FollowedRun run = follow(session, disturbance, kInfinite, wanted);
  if (!run.completed) throw RunError("a run that was to tell how far to trust the first one failed: " + run.message);
  return run;
}

/// The runs of a scene, one after the other, and what they come to.
class Judgement {
 public:
  explicit Judgement(scene::Scene& session)
      : session_(session),
        run_(follow_or_throw(session, 0.0, {.states = true, .numbers = true, .impacts = true})),
        method_(method_of(session, run_)) {}

  record::Trust pronounce() {
    run_again();
    add(run_);
    record::TrustRuns runs;
    runs.run = run_.histories;
    std::string tightened;
    if (auto tight = tighten(session_, tightened)) {
      const FollowedRun run = follow_or_throw(*tight, 0.0, kNumbers);
      runs.tightened = run.histories;
      add(run);
    } else {
      tightened.clear();
    }
    if (other_) {
      runs.other = other_->run.histories;
      runs.is_exact = other_->is_exact;
      add(other_->run);
      runs.again = again_.histories;
    }
    runs.growth = growth();
    record::Trust trust = record::judge(runs, session_.output.trust_accuracy);
    trust.tightened = tightened;
    trust.other = other_ ? other_->method : "";
    add_statistics(trust);
    return trust;
  }

 private:
  void run_again() {
    other_ = run_other_family(session_, method_, tolerance_of(session_, method_), run_.size, run_.work);
    if (other_)
      again_ = follow_or_throw(other_->again, kRounding * peak_of(run_), {});
    else
      log::warning(
          "no method of another family takes this scene within reason; errors that are the method's own stay "
          "unseen by --trust");
  }

  /// The size of disturbances that are followed by a method whose steps err by `noise`.
  static double disturbance(double noise) { return std::clamp(kAboveNoise * noise, kSmallest, kLargest); }

  record::Growth growth() {
    const double own_size = disturbance(tolerance_of(session_, method_));
    const double other_size = other_ ? disturbance(other_->noise) : own_size;
    // The finer disturbance tells more; of two that are alike the cheaper run.
    const bool by_other =
        other_ && !is_closed_form(method_) && (other_size < own_size || other_->run.work <= run_.work);
    scene::Scene& by = by_other ? other_->session : session_;
    const FollowedRun& run = by_other ? other_->run : run_;
    const double size = by_other ? other_size : own_size;
    record::Growth growth = follow_disturbance(by, run, size);
    if (run.size > kLargeSystem) return growth;
    // To both sides: a start on the border between two sides of a stop moves on differently.
    const double start = size * peak_of(run);
    for (const double sign : {1.0, -1.0})
      if (start > 0.0)
        growth.displaced =
            std::max(growth.displaced,
                     record::largest_difference(run.histories, follow_or_throw(by, sign * start, {}).histories) /
                         (start * largest_perturbation(run.size)));
    return growth;
  }

  void add(const FollowedRun& run) {
    values_.resize(run.numbers.size());
    for (std::size_t i = 0; i < run.numbers.size(); ++i) values_[i].push_back(run.numbers[i].value);
  }

  void add_statistics(record::Trust& trust) {
    if (!trust.to_the_end)
      for (const double sign : {1.0, -1.0}) add(follow_or_throw(session_, sign * kElsewhere * peak_of(run_), kNumbers));
    const double factor = trust.to_the_end ? kAgreeing : kScattering;
    // Extremes are found to a part of them.
    const double rounding = std::max(record::StepPath::kGood, 1e-14 * std::min(1e6, trust.amplification));
    for (std::size_t i = 0; i < values_.size(); ++i)
      trust.statistics.push_back(record::bracket(run_.numbers[i].name, values_[i], run_.numbers[i].is_count, factor,
                                                 rounding * std::abs(values_[i].front())));
  }

  scene::Scene& session_;
  FollowedRun run_;
  std::string method_;
  std::optional<OtherRun> other_;
  FollowedRun again_;
  std::vector<std::vector<double>> values_;  ///< of every number, by run
};

}  // namespace

record::Trust find_trust(scene::Scene& session) {
  return Judgement(session).pronounce();
}

}  // namespace butee::app

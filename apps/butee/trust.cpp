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
/// Perturbation of the initial displacements at the level of rounding, relative to the peak.
constexpr double kRounding = 1e-16;
/// Size of disturbances relative to the motion: kAboveNoise times the error of a step, within [kSmallest,
/// kLargest].
constexpr double kAboveNoise = 1e4, kSmallest = 1e-8, kLargest = 1e-3;
/// Perturbation of the initial displacements in further runs of a chaotic scene, relative to the peak.
constexpr double kElsewhere = 1e-6;
/// Half-width of a number's interval around the judged run, in ranges of the runs. If the runs agree: 1.5, as
/// for rows (record::judge). If they do not: 2.2, because for a sample of five runs a 99 % prediction
/// interval extends 4.6 sqrt(6/5) standard deviations to each side, which is 2.2 times the expected range.
constexpr double kAgreeing = 1.5, kScattering = 2.2;
constexpr double kFinestTolerance = 1e-12;
constexpr Wanted kNumbers = {.states = false, .numbers = true, .impacts = true};

/// The scene with half the step, a tenth of the tolerance, or a finer value of the method's own accuracy key;
/// empty if the method has none.
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
    return std::nullopt;  // the accuracy key is at its limit
  }
}

/// The method that integrates: the choice of `auto`, or the scene's method.
std::string method_of(const scene::Scene& session, const FollowedRun& run) {
  return run.choice.empty() ? session.integrator.name : run.choice.substr(0, run.choice.find_first_of(" :"));
}

double peak_of(const FollowedRun& run) {
  double peak = 0.0;
  for (const auto& history : run.histories.values)
    for (const double value : history) peak = std::max(peak, std::abs(value));
  return peak;
}

/// The largest entry of the initial disturbance, relative to its size.
double largest_perturbation(Index size) {
  Vector x = Vector::Zero(size);
  perturb(x, 1.0);
  return x.lpNorm<Eigen::Infinity>();
}

FollowedRun follow_or_throw(scene::Scene& session, double disturbance, Wanted wanted) {
  FollowedRun run = follow(session, disturbance, kInfinite, wanted);
  if (!run.completed) throw RunError("a run for the accuracy estimate failed: " + run.message);
  return run;
}

/// Nothing if the run fails, or if the method refuses the scene, for example a tolerance below its smallest one: the
/// estimate then goes without this run.
std::optional<FollowedRun> follow_if_possible(scene::Scene& session, double disturbance, Wanted wanted) {
  try {
    FollowedRun run = follow(session, disturbance, kInfinite, wanted);
    if (run.completed) return run;
    log::warning("the accuracy estimate goes without one of its runs, which failed: " + run.message);
  } catch (const InputError&) {
  }
  return std::nullopt;
}

/// Performs the runs of a scene one after the other and evaluates them.
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
      const std::optional<FollowedRun> run = follow_if_possible(*tight, 0.0, kNumbers);
      if (run) {
        runs.tightened = run->histories;
        add(*run);
      } else {
        tightened.clear();
      }
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
    other_ = run_other_family(session_, method_, tolerance_of(session_.integrator, method_).value_or(0.0), run_.size,
                              run_.work);
    if (other_) {
      auto again = follow_if_possible(other_->again, kRounding * peak_of(run_), {});
      if (again)
        again_ = std::move(*again);
      else
        other_.reset();  // follow_if_possible() has told why
    } else {
      log::warning(
          "no method of another family can run this scene at reasonable cost; --trust cannot detect systematic errors "
          "of the method");
    }
  }

  /// The size of disturbances to follow with a method whose error in a step is `noise`.
  static double disturbance(double noise) { return std::clamp(kAboveNoise * noise, kSmallest, kLargest); }

  record::Growth growth() {
    // Without error control the errors of steps are unknown.
    const double unknown = scene::has_truncation(method_) ? kLargest : 0.0;
    const std::optional<double> tolerance = tolerance_of(session_.integrator, method_);
    const double own_size = disturbance(tolerance.value_or(unknown));
    const double other_size = other_ ? disturbance(other_->noise) : own_size;
    // Prefer the smaller disturbance; if both are equal, the cheaper run.
    const bool by_other =
        other_ && scene::has_truncation(method_) && (other_size < own_size || other_->run.work <= run_.work);
    scene::Scene& by = by_other ? other_->session : session_;
    const FollowedRun& run = by_other ? other_->run : run_;
    const double size = by_other ? other_size : own_size;
    record::Growth growth = follow_disturbance(by, run, size, !by_other && unknown > 0.0 && !tolerance);
    if (run.size > kLargeSystem) return growth;
    // Both signs: a start at the contact boundary continues differently on its two sides.
    const double start = size * peak_of(run);
    if (!(start > 0.0)) return growth;
    for (const double sign : {1.0, -1.0})
      if (const auto displaced = follow_if_possible(by, sign * start, {}))
        growth.displaced = std::max(growth.displaced, record::largest_difference(run.histories, displaced->histories) /
                                                          (start * largest_perturbation(run.size)));
    return growth;
  }

  void add(const FollowedRun& run) {
    values_.resize(run.numbers.size());
    for (std::size_t i = 0; i < run.numbers.size(); ++i) values_[i].push_back(run.numbers[i].value);
  }

  void add_statistics(record::Trust& trust) {
    if (!trust.to_the_end)
      for (const double sign : {1.0, -1.0})
        if (const auto elsewhere = follow_if_possible(session_, sign * kElsewhere * peak_of(run_), kNumbers))
          add(*elsewhere);
    const double factor = trust.to_the_end ? kAgreeing : kScattering;
    // Extremes are located only to a relative tolerance.
    const double rounding = std::max(record::StepPath::kGood, 1e-14 * std::min(1e6, trust.amplification));
    for (std::size_t i = 0; i < values_.size(); ++i)
      trust.statistics.push_back(record::bracket(run_.numbers[i].name, values_[i], run_.numbers[i].is_count, factor,
                                                 rounding * std::abs(values_[i].front()) + run_.numbers[i].rounding));
  }

  scene::Scene& session_;
  FollowedRun run_;
  std::string method_;
  std::optional<OtherRun> other_;
  FollowedRun again_;
  std::vector<std::vector<double>> values_;  ///< values of every number, one for each run
};

}  // namespace

record::Trust find_trust(scene::Scene& session) {
  return Judgement(session).pronounce();
}

}  // namespace butee::app

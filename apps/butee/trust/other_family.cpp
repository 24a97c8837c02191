#include "other_family.hpp"

#include <algorithm>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>

#include "../compare/study.hpp"

namespace butee::app::trust {
namespace {

/// Limit of a run's work: the larger of `work` and `times` that of the judged run.
struct Budget {
  double work, times;
};
/// Abandoned candidates cost at most a few runs of the judged method. The series of `exact` cost ten times
/// the counted work, so that `exponential` comes first if they are long. Other methods follow disturbances
/// through contacts too inaccurately to come before `exact`.
constexpr Budget kQuick = {4e7, 0.1}, kUsual = {1.5e8, 2.0}, kLong = {2e9, 30.0};

/// Methods in order of accuracy, with the tolerance used for each.
struct Candidate {
  const char* name;
  double tolerance;  ///< 0: exact
  Budget budget = kUsual;
  bool is_implicit = false;
};
constexpr Candidate kCandidates[] = {{"exact", 0.0, kQuick},    {"exponential", 1e-8},
                                     {"exponential", 1e-5},     {"exact", 0.0, kLong},
                                     {"extrapolation8", 1e-10}, {"rodas4", 1e-8, kUsual, true},
                                     {"dopri5", 1e-9},          {"bathe_adaptive", 1e-6, kUsual, true}};
/// Settings of the repetition: another order for exact, a looser tolerance by this factor for others.
constexpr std::int64_t kOtherOrder = 22;
constexpr double kLooser = 3.0;
/// Largest tolerance, as a fraction of the judged run's tolerance.
constexpr double kTighter = 0.03;
/// Large systems use implicit methods only, with this fraction of the judged run's tolerance.
constexpr double kTighterOfLarge = 0.1, kUsualTolerance = 1e-4;
/// The rounding error of an interval between two states, relative to the motion.
constexpr double kRounding = 1e-13;

scene::Scene session_with(const scene::Scene& session, const Candidate& candidate, double tolerance, bool again) {
  plugin::Catalogue catalogue = session.catalogue;
  const time::IntegratorType& type = catalogue.load(candidate.name);
  config::Table settings;
  if (candidate.tolerance > 0.0)
    settings["tolerance"] = config::Value(again ? kLooser * tolerance : tolerance);
  else if (again)
    settings["order"] = config::Value(kOtherOrder);
  const compare::Sweep sweep{candidate.name, "", true, {}, std::move(settings)};
  return scene::read_scene(compare::with_method(session.document, type, sweep, 0.0), std::move(catalogue));
}

}  // namespace

std::optional<OtherRun> run_other_family(const scene::Scene& session, const std::string& method, double tolerance,
                                         Index size, double work) {
  for (const Candidate& candidate : kCandidates) {
    if (method == candidate.name || session.catalogue.find(candidate.name) == nullptr) continue;
    const bool is_large = size > kLargeSystem;
    if (is_large && !candidate.is_implicit) continue;
    const double tight = is_large          ? kTighterOfLarge * (tolerance > 0.0 ? tolerance : kUsualTolerance)
                         : tolerance > 0.0 ? std::min(candidate.tolerance, kTighter * tolerance)
                                           : candidate.tolerance;
    try {
      OtherRun other{candidate.name,
                     candidate.tolerance == 0.0,
                     candidate.tolerance == 0.0 ? kRounding : tight,
                     session_with(session, candidate, tight, false),
                     session_with(session, candidate, tight, true),
                     {}};
      const Budget& budget = candidate.budget;
      other.run = follow(other.session, 0.0, std::max(budget.work, budget.times * work),
                         {.states = true, .numbers = true, .impacts = true});
      if (other.run.completed) return other;
      log::debug(other.method + ": " + other.run.message);
    } catch (const InputError& error) {
      log::debug(std::string(candidate.name) + ": " + error.what());
    }
  }
  return std::nullopt;
}

}  // namespace butee::app::trust

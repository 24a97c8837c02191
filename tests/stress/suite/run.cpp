#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/plugin/catalogue.hpp>

#include "work.hpp"

namespace butee::stress {
namespace {

using test::SceneRun;

/// A motion larger than the true one by this factor counts as unbounded growth, not as inaccuracy.
constexpr double kGrown = 1e3;
/// Limit in CPU seconds, far above the time at which the work limit is reached.
constexpr double kHung = 20.0;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

enum class End { over, cut, hung };

End advance(SceneRun& run, std::int64_t work) {
  const double begin = cpu_seconds();
  for (std::int64_t i = 0; i < work; ++i) {
    if (!run.simulation().advance()) return End::over;
    if (work_of(run.dynamics().counters()) > work) return End::cut;
    if (i % 64 == 0 && cpu_seconds() - begin > kHung) return End::hung;
  }
  return End::cut;
}

std::string settings(const Scene& scene, const Method& method, const Reference& reference) {
  const std::string type = "type = \"" + method.name + "\"\n";
  const double step = std::min(scene.step_factor * reference.critical_step(), 0.2 * reference.end_time());
  const std::string time_step = "time_step = " + to_text(step) + "\n";
  if (method.is_controlled || method.is_foreign) return type + "tolerance = " + to_text(scene.tolerance) + "\n";
  if (method.name == "rk4_fixed_factors")
    return type + time_step + "shrink = 1.3\ngrow = 1.5\ntolerance = " + to_text(scene.tolerance * scene.size) + "\n";
  if (method.name == "rk4_error_scaled")
    return type + time_step + "safety = 0.8\ntolerance = " + to_text(scene.tolerance * scene.size) + "\n";
  std::string keys = type + time_step;
  if (method.name == "newmark" || method.name == "newmark_adaptive")
    keys += "residual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations = 30\n";
  if (method.name == "newmark_adaptive" || method.name == "newmark_modified_adaptive")
    keys += "target_error = " + to_text(0.1 * scene.tolerance) + "\n";
  return keys;
}

void judge(const Method& method, Reference& reference, const Follower& follower, Outcome& outcome) {
  if (!follower.trajectory.is_finite) {
    outcome.verdict = Verdict::not_finite;
    return;
  }
  if (!reference.exists()) return;
  Judgement found = reference.promise().judge(follower.trajectory);
  while (method.is_judged && found.excess > 1.0 && reference.can_refine()) {
    reference.refine(found.row);
    outcome.level = reference.level();
    if (!reference.exists()) return;
    found = reference.promise().judge(follower.trajectory);
  }
  outcome.error = found.error;
  outcome.allowed = found.allowed;
  outcome.excess = found.excess;
  outcome.level = reference.level();
  outcome.part = static_cast<double>(std::min(reference.promise().rows(), follower.trajectory.rows)) / Reference::kRows;
  if (follower.largest > kGrown * reference.peak() && !outcome.has_warned)
    outcome.verdict = Verdict::grown;
  else if (outcome.excess <= 1.0)
    outcome.verdict = Verdict::correct;
  else
    outcome.verdict = method.is_judged ? Verdict::wrong : Verdict::inaccurate;
  if (outcome.verdict == Verdict::wrong) outcome.message += reference.place(found);
}

}  // namespace

const char* name_of(Verdict verdict) {
  const char* const names[] = {"correct", "inaccurate", "diagnosed",  "refused", "unjudged",
                               "wrong",   "grown",      "not finite", "silent",  "hung"};
  return names[static_cast<int>(verdict)];
}

bool is_failure(Verdict verdict) {
  return static_cast<int>(verdict) >= static_cast<int>(Verdict::wrong);
}

std::vector<Method> methods() {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  std::vector<Method> all;
  for (const auto& entry : catalogue.integrators()) {
    const auto& type = entry.declaration;
    if (type.name == "exact") continue;
    // Methods that need no first step have a relative, guaranteed tolerance. SUNDIALS controls each component
    // in each step; it is included for comparison, and its errors are only recorded.
    const bool is_foreign = entry.module.find("sundials") != std::string::npos;
    const bool is_controlled = type.finds_first_step && !is_foreign;
    all.push_back({type.name, is_controlled, is_foreign, is_controlled});
  }
  return all;
}

std::string integrator(const Scene& scene, const Method& method, const Reference& reference) {
  return "[integrator]\n" + settings(scene, method, reference) + "end_time = " + to_text(reference.end_time()) + "\n";
}

Outcome run(const Scene& scene, const Method& method, Reference& reference, std::int64_t work) {
  Outcome outcome;
  const log::WithoutWarnings quiet;
  const double begin = cpu_seconds();
  try {
    SceneRun run(scene.toml + integrator(scene, method, reference));
    Follower follower(run.dynamics().size(), reference.instants());
    run.simulation().add(follower);
    const End end = advance(run, work);
    outcome.seconds = cpu_seconds() - begin;
    outcome.was_cut = end == End::cut;
    const time::RunReport& report = run.simulation().report();
    outcome.steps = report.steps;
    outcome.message = report.message;
    outcome.has_warned = !report.warnings.empty();
    judge(method, reference, follower, outcome);
    if (end == End::hung) outcome.verdict = Verdict::hung;
    const bool stopped = end == End::over && !report.completed;
    if (stopped && outcome.verdict != Verdict::wrong && outcome.verdict != Verdict::not_finite)
      outcome.verdict = outcome.message.find("t = ") != std::string::npos ? Verdict::diagnosed : Verdict::silent;
  } catch (const InputError& error) {
    outcome.verdict = Verdict::refused;
    outcome.message = error.what();
  }
  return outcome;
}

}  // namespace butee::stress

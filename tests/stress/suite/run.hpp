#pragma once

#include <string>
#include <vector>

#include "reference.hpp"

namespace butee::stress {

/// A method with the keys that it runs with.
struct Method {
  std::string name;
  bool is_controlled = false;  ///< its tolerance is guaranteed: answers are within it, or the run stops
  bool is_foreign = false;     ///< a method of SUNDIALS
  bool is_judged = false;      ///< judged by the guaranteed bound; other methods are only recorded
};

/// Every method of the catalogue except `exact`, the reference.
std::vector<Method> methods();

/// The outcome of a run.
enum class Verdict {
  correct,     ///< completed or cut, within the allowed error up to the trust horizon
  inaccurate,  ///< method without error control: completed, finite and bounded, with a larger error
  diagnosed,   ///< stopped with an explanation
  refused,     ///< refused before the first step, with a message
  unjudged,    ///< finite and bounded, but without a reference
  wrong,       ///< method with error control: error above the allowed one
  grown,       ///< grown beyond any possible motion of the scene without a message or a warning of its steps
  not_finite,  ///< contains non-finite results
  silent,      ///< stopped without an explanation
  hung         ///< exceeded the time limit
};
inline constexpr int kVerdicts = 10;
const char* name_of(Verdict verdict);
/// True for outcomes that count as failures.
bool is_failure(Verdict verdict);

struct Outcome {
  Verdict verdict = Verdict::unjudged;
  double error = 0.0;    ///< the largest e up to the horizon
  double allowed = 0.0;  ///< at the instant where e/allowed was largest
  double excess = 0.0;   ///< e / allowed there
  double part = 0.0;     ///< fraction of the run that was compared
  int level = 0;         ///< refinement level of the reference used
  std::int64_t steps = 0;
  bool was_cut = false;  ///< stopped at the work limit
  bool has_warned = false;
  double seconds = 0.0;
  std::string message;
};

/// Runs one method, limited to `work` evaluations and solves. An answer counts as wrong only under the
/// largest Gamma that `reference` finds; the reference is refined for this.
Outcome run(const Scene& scene, const Method& method, Reference& reference, std::int64_t work);

/// The keys of [integrator] for a method, `type` and `end_time` included.
std::string integrator(const Scene& scene, const Method& method, const Reference& reference);

}  // namespace butee::stress

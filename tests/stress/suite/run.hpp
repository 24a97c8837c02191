#pragma once

#include <string>
#include <vector>

#include "reference.hpp"

namespace butee::stress {

/// A method with the keys that it runs with.
struct Method {
  std::string name;
  bool is_controlled = false;  ///< its tolerance is a promise: its answers are correct or it stops
  bool is_foreign = false;     ///< of SUNDIALS
  bool is_judged = false;      ///< by its promise; all others are recorded
};

/// Every method of the catalogue but `exact`, which judges them.
std::vector<Method> methods();

/// What became of a run.
enum class Verdict {
  correct,     ///< completed or cut, within the error that is allowed up to the trust horizon
  inaccurate,  ///< of a method without error control: completed, finite and bounded, but with a larger error
  diagnosed,   ///< stopped, and said why
  refused,     ///< refused before the first step, with a message
  unjudged,    ///< finite and bounded, but there is no reference
  wrong,       ///< of a method with error control: more error than is allowed
  grown,       ///< larger than anything that the scene can do, without a word, a warning of its steps included
  not_finite,  ///< a result is no number
  silent,      ///< stopped without a diagnosis
  hung         ///< took more time than any run may
};
inline constexpr int kVerdicts = 10;
const char* name_of(Verdict verdict);
/// The ones that must not happen.
bool is_failure(Verdict verdict);

struct Outcome {
  Verdict verdict = Verdict::unjudged;
  double error = 0.0;    ///< the largest e up to the horizon
  double allowed = 0.0;  ///< at the instant where e was the largest part, or the most times, of it
  double excess = 0.0;   ///< e / allowed there
  double part = 0.0;     ///< of the run that was compared
  int level = 0;         ///< of the reference that it was compared with
  std::int64_t steps = 0;
  bool was_cut = false;  ///< at the bound of its work
  bool has_warned = false;
  double seconds = 0.0;
  std::string message;
};

/// Runs one method, bounded by `work` evaluations and solves.
/// A wrong answer is one under the largest Gamma that `reference` finds, which is refined for it.
Outcome run(const Scene& scene, const Method& method, Reference& reference, std::int64_t work);

/// The keys of [integrator] for a method, `type` and `end_time` included.
std::string integrator(const Scene& scene, const Method& method, const Reference& reference);

}  // namespace butee::stress

#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::stress {

/// A method with the keys that it runs with.
struct Method {
  std::string name;
  bool is_controlled = false;  ///< its tolerance is a promise: its answers are correct or it stops
  bool is_foreign = false;     ///< of SUNDIALS
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
  double error = 0.0;    ///< the largest up to the horizon, relative to the peak
  double allowed = 0.0;  ///< of a wrong one: at the instant where it was the most times too large
  double excess = 0.0;   ///< the largest error / allowed
  bool was_cut = false;  ///< at the bound of its work
  bool has_warned = false;
  double seconds = 0.0;
  std::string message;
};

/// The solution by `exact`, and how starts that differ a little part from it.
class Reference {
 public:
  /// `work` bounds each of its runs.
  Reference(const Scene& scene, std::int64_t work);

  bool exists() const { return !instants_.empty(); }
  /// Instants up to the trust horizon.
  const std::vector<double>& instants() const { return instants_; }
  double peak() const { return peak_; }
  double critical_step() const { return critical_step_; }
  const Vector& at(std::size_t i) const { return motion_[i]; }
  double allowed(std::size_t i) const { return allowed_[i]; }

 private:
  std::vector<double> instants_, allowed_;
  std::vector<Vector> motion_;
  double peak_ = 0.0, critical_step_ = 0.0;
};

/// Runs one method, bounded by `work` evaluations and solves.
Outcome run(const Scene& scene, const Method& method, const Reference& reference, std::int64_t work);

}  // namespace butee::stress

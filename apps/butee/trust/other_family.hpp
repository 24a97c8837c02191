#pragma once

#include <optional>

#include "followed_run.hpp"

namespace butee::app::trust {

/// A run by a method unrelated to that of the scene.
struct OtherRun {
  std::string method;
  bool is_exact;         ///< without truncation error
  double noise;          ///< error of a step relative to the motion: rounding or the tolerance
  scene::Scene session;  ///< the scene with that method
  scene::Scene again;    ///< the same with another order or a looser tolerance
  FollowedRun run;       ///< the run with its states
};

/// The first method of another family than `method` (a canonical name, also if `auto` chose it) that takes
/// the scene with `size` DOFs within a budget in proportion to the `work` of the judged run; `exact` if
/// possible. Tolerances are tight, and below `tolerance` if that is not 0.
std::optional<OtherRun> run_other_family(const scene::Scene& session, const std::string& method, double tolerance,
                                         Index size, double work);

}  // namespace butee::app::trust

#pragma once

#include <optional>

#include "followed_run.hpp"

namespace butee::app::trust {

/// A run by a method that has nothing in common with that of the scene.
struct OtherRun {
  std::string method;
  bool is_exact;         ///< without truncation error
  double noise;          ///< of a step, relative to the motion: rounding or the tolerance
  scene::Scene session;  ///< the scene with that method
  scene::Scene again;    ///< and with another order or a looser tolerance
  FollowedRun run;       ///< with its states
};

/// The first method of another family than `method` (a canonical name, that of `auto`'s choice included) that takes the
/// scene, of `size` DOFs, and stays in proportion to the `work` of the judged run: exact where it can. Tight
/// tolerances; below `tolerance` where that is one.
std::optional<OtherRun> run_other_family(const scene::Scene& session, const std::string& method, double tolerance,
                                         Index size, double work);

}  // namespace butee::app::trust

#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// The kinds of pictures of a run.
enum class Kind {
  displacement,
  force,
  step,
  energy,
  phase,
  spectrum,
  shape,
  moment,
  shear,
  stress,
  spring,
  reaction,
  orbit,
  run_up,
  full_spectrum,
  contact_map,
  wear,
  frame
};

/// "displacement", ... in the order of the kinds.
std::vector<std::string> kind_names();
Kind kind_of(const std::string& name);

/// The pictures of a kind that the results allow; empty if required data are missing. The probes of one run
/// share a picture if it remains readable; several runs share a picture for each probe. `labels`: the probes
/// to draw; empty: all.
std::vector<Picture> pictures(Kind kind, const std::vector<Result>& results, const std::vector<std::string>& labels);

/// The data that a kind requires of a result, and how to obtain them.
std::string requirement_of(Kind kind);

}  // namespace butee::app::plot

#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// What can be drawn of a run.
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

/// "displacement", ... in this order.
std::vector<std::string> kind_names();
Kind kind_of(const std::string& name);

/// The pictures of a kind that the results allow, none where they lack what it needs. Of one run the probes share a
/// picture where that can be read; several runs share a picture for each probe. `labels` are the probes to draw, all
/// where it is empty.
std::vector<Picture> pictures(Kind kind, const std::vector<Result>& results, const std::vector<std::string>& labels);

/// What a result needs for a kind, and how to get it.
std::string requirement_of(Kind kind);

}  // namespace butee::app::plot

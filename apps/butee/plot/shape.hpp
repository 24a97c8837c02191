#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// Space-time pictures of a run, one for each beam: displacement by colour over time and place, and where stops are
/// closed as lines. Nothing where the fields hold no beam or no u.
std::vector<Picture> shape_pictures(const Result& result, model::FieldReader& fields, Window window, bool several);

}  // namespace butee::app::plot

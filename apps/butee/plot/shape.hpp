#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// Space-time pictures of a run, one for each beam: displacement as colour over time and position, and closed
/// phases of stops as lines. Empty if the fields contain no beam or no u.
std::vector<Picture> shape_pictures(const Result& result, model::FieldReader& fields, Window window, bool several);

}  // namespace butee::app::plot

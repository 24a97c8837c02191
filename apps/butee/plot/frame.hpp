#pragma once

#include <butee/model/field_format.hpp>

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// Draws a structure in space at rest and, with scaled displacements, at the instant of its largest
/// displacement; empty if all beams lie along x.
std::vector<Picture> frame_pictures(const Result& result, model::FieldReader& fields, Window window, bool several);

}  // namespace butee::app::plot

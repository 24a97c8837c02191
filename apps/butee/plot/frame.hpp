#pragma once

#include <butee/model/field_format.hpp>

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// A structure in space at rest and, drawn larger, at the instant of its largest displacement; nothing where all beams
/// lie along x.
std::vector<Picture> frame_pictures(const Result& result, model::FieldReader& fields, Window window, bool several);

}  // namespace butee::app::plot

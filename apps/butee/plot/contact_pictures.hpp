#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// Every closing in impacts.csv as a line over its time, at the place of its contact, coloured by its largest force;
/// nothing where there is none within the window.
std::vector<Picture> contact_map(const Result& result, Window window, bool several);

/// The mean power and the share of time in contact of wear.csv over the places of the contacts; nothing where no
/// contact ever rubbed.
std::vector<Picture> wear_picture(const Result& result, bool several);

}  // namespace butee::app::plot

#pragma once

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// Draws every closing in impacts.csv as a line over its time, at the position of its contact, coloured by
/// its largest force; empty if there is none in the window.
std::vector<Picture> contact_map(const Result& result, Window window, bool several);

/// Draws the mean friction power and the fraction of time in contact from wear.csv over the positions of the
/// contacts; empty if no contact ever rubbed.
std::vector<Picture> wear_picture(const Result& result, bool several);

}  // namespace butee::app::plot

#pragma once

#include "drawing.hpp"

namespace butee::app::plot {

/// uz over uy of a probe: the orbit of a node.
std::vector<Chart> of_orbit(const Drawing& drawing);

/// hypot(uy, uz), or the one that a probe has, over the speed of [rotation], where that varies.
std::vector<Chart> of_run_up(const Drawing& drawing);

/// The amplitudes of uy + i uz: forward whirl at frequencies above zero, backward whirl below.
std::vector<Chart> of_full_spectrum(const Drawing& drawing);

}  // namespace butee::app::plot

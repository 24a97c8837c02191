#pragma once

#include "drawing.hpp"

namespace butee::app::plot {

/// uz over uy of a probe: the orbit of the node.
std::vector<Chart> of_orbit(const Drawing& drawing);

/// The orbit radius hypot(uy, uz), or |u| for a probe with one direction, over a varying speed of [rotation].
std::vector<Chart> of_run_up(const Drawing& drawing);

/// The amplitude spectrum of uy + i uz: forward whirl at positive frequencies, backward whirl at negative
/// ones.
std::vector<Chart> of_full_spectrum(const Drawing& drawing);

}  // namespace butee::app::plot

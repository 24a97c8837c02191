#pragma once

#include "drawing.hpp"

namespace butee::app::plot {

/// A quantity of the probes over time, as pictures of the base name `name`. The probes of one run share a picture;
/// several runs share a picture for each probe. Empty if no probe has the quantity.
std::vector<Chart> over_time(const Drawing& drawing, const std::string& name, const std::string& quantity,
                             const std::string& y_name, const std::string& y_unit);

/// The displacements u, with gaps; where no probe has one, those along the other axes or the rotations.
std::vector<Chart> of_motion(const Drawing& drawing);
/// The length of steps over time.
std::vector<Chart> of_steps(const Drawing& drawing);
/// Energies over time: of one run its parts and the balance, of several runs the sums.
std::vector<Chart> of_energy(const Drawing& drawing);
/// Velocity over displacement, for each probe.
std::vector<Chart> of_phase(const Drawing& drawing);
/// The amplitude spectrum of u.
std::vector<Chart> of_spectrum(const Drawing& drawing);

}  // namespace butee::app::plot

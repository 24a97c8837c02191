#pragma once

#include <functional>

#include <butee/model/system.hpp>

namespace butee::app {

/// Adds a fixed sequence of pseudo-random numbers between -size and size.
void perturb(Vector& x, double size);

/// Applies `perturb` to the initial displacements (m or rad) of an assembled system; an empty function if
/// `size` is 0.
std::function<void(model::System&)> perturbed_by(double size);

}  // namespace butee::app

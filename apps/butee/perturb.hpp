#pragma once

#include <functional>

#include <butee/model/system.hpp>

namespace butee::app {

/// Adds numbers between -size and size, with no pattern of the structure's, always the same.
void perturb(Vector& x, double size);

/// The same to the initial displacements (m or rad) of a system that is assembled; nothing where `size` is 0.
std::function<void(model::System&)> perturbed_by(double size);

}  // namespace butee::app

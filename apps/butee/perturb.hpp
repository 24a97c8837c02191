#pragma once

#include <butee/core/types.hpp>

namespace butee::app {

/// Adds numbers between -size and size, with no pattern of the structure's, always the same.
void perturb(Vector& x, double size);

}  // namespace butee::app

#pragma once

#include <array>

#include "butee/linalg/force_balance.hpp"

namespace butee::linalg::kernel {

/// residual := F + F_c - M a - C v - K x for `count` rows. Adds the squares of the terms, in the
/// order of ForceTerms, to `squares` and those of the residual to `residual_square`.
using AddForces = void (*)(const ForceTerms&, Index count, double* residual, std::array<double, 5>& squares,
                           double& residual_square);

/// For the chosen instruction set.
AddForces add_forces();

}  // namespace butee::linalg::kernel

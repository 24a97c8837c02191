#pragma once

#include "butee/model/model.hpp"

namespace butee::dynamics {

/// The smallest factor > 0 of all preloads of a model at which its stiffness is singular: linear
/// buckling, det(K + factor K_g) = 0, stops open, nothing turning. Infinite if there is none up to
/// `up_to`; NaN if K itself is not positive definite, as for a mechanism.
///
/// K + factor K_g is factorized and the negative pivots are counted (Sylvester); bisection finds
/// the factor to rounding. Checked against Euler's cases in tests/verification/preload_test.cpp.
/// The preloads of `model` are changed during the computation and restored.
BUTEE_EXPORT double critical_preload_factor(model::Model& model, double up_to = 1e6);

}  // namespace butee::dynamics

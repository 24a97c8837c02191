#pragma once

#include "butee/core/types.hpp"

namespace butee::solve {

/// The forces of one instant, n entries each; contact and damping are null where a scene has none.
struct ForceTerms {
  const double* load;     ///< F
  const double* contact;  ///< F_c
  const double* inertia;  ///< M a
  const double* damping;  ///< C v
  const double* elastic;  ///< K x
};

/// residual := F + F_c - M a - C v - K x; returns |F| + |F_c| + |M a| + |C v| + |K x| (2-norms), in one pass.
double force_balance(const ForceTerms& terms, Index size, double* residual);

}  // namespace butee::solve

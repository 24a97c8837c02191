#pragma once

#include <span>

#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// Where a step begins.
struct PropagationStart {
  double t;  ///< s
  const Eigen::ArrayXd &q, &v;
  std::span<const Phase> phases;         ///< of the harmonic loads at t
  const Eigen::ArrayXd* constant_force;  ///< modal; nullptr: none
};

/// Propagates the modes to t_end, under all loads and a constant force but without contact; `v` only where it is given.
/// Exact for constant, linear and harmonic loads; any other is the parabola through its values at the start, in the
/// middle and at the end. Checked in tests/unit/propagation_test.cpp.
void propagate(const dynamics::ModalSystem& modal, const dynamics::ModalPropagator& flow, const PropagationStart& start,
               double t_end, Eigen::ArrayXd& q, Eigen::ArrayXd* v);

}  // namespace butee::integrators

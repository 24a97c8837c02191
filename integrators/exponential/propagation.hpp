#pragma once

#include <span>

#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// The state and loads at the start of a step.
struct PropagationStart {
  double t;  ///< s
  const Eigen::ArrayXd &q, &v;
  std::span<const Phase> phases;         ///< phases of the harmonic loads at t
  const Eigen::ArrayXd* constant_force;  ///< modal; nullptr: none
};

/// Propagates the modes to t_end under all loads and a constant force, without contact; `v` may be
/// null. Exact for constant, linear and harmonic loads; any other load is replaced by the parabola
/// through its values at the start, in the middle and at the end. Checked in
/// tests/unit/propagation_test.cpp.
void propagate(const dynamics::ModalSystem& modal, const dynamics::ModalPropagator& flow, const PropagationStart& start,
               double t_end, Eigen::ArrayXd& q, Eigen::ArrayXd* v);

}  // namespace butee::integrators

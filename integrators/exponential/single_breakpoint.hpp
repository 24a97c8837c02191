#pragma once

#include "integrators/exponential/contact_path.hpp"
#include "integrators/exponential/force_moments.hpp"
#include "integrators/exponential/oscillator.hpp"
#include "integrators/exponential/single_mode.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// A breakpoint of one DOF with one stop, and the path and the force of the step that begins there.
struct SingleBreakpoint {
  double t;
  Oscillator::Point at;
  bool has_motion = false;  ///< `motion` is known
  Motion motion{};

  struct Step {
    double hv0 = 0.0, hv1 = 0.0,
           quartic = 0.0;  ///< h times the speeds of the stop at the ends, and the quartic coefficient, m
    ForceMoments force{};
  };
  Step step{};
};

/// The path of the stop from a breakpoint to the next one.
ContactPath path_between(const SingleMode& mode, const SingleBreakpoint& from, const SingleBreakpoint& to);

}  // namespace butee::integrators

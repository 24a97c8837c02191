#pragma once

#include <memory>
#include <string>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// The method that `auto` selects for a scene, and the reason.
struct Choice {
  enum class Method { piecewise, exponential, exact, extrapolation8, rodas4, dopri5 };
  Method method;
  std::string why;
};

/// piecewise for few DOFs with linear stops; exponential if all modes can be computed and only contacts
/// are approximated; dopri5, extrapolation8 and rodas4 otherwise, and rodas4 if it is expected to finish before the
/// modes of a large system are computed. The methods of high order that tight tolerances need are tried by
/// make_automatic().
Choice choose(dynamics::Dynamics& dynamics, double tolerance, double end_time);

/// The chosen method with this tolerance; it carries the reason of the choice.
std::unique_ptr<time::Integrator> make_automatic(dynamics::Dynamics& dynamics, double tolerance, double end_time);

}  // namespace butee::integrators

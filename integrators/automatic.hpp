#pragma once

#include <memory>
#include <string>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// The method that `auto` selects for a scene, and the reason.
struct Choice {
  enum class Method { piecewise, exponential, rodas4, dopri5 };
  Method method;
  std::string why;
};

/// piecewise for few DOFs with linear stops; exponential if all modes can be computed and only the
/// stops couple them; rodas4 otherwise, and if it is expected to finish before the modes of a large
/// system are computed.
Choice choose(dynamics::Dynamics& dynamics, double tolerance, double end_time);

/// The chosen method with this tolerance; it carries the reason of the choice.
std::unique_ptr<time::Integrator> make_automatic(dynamics::Dynamics& dynamics, double tolerance, double end_time);

}  // namespace butee::integrators

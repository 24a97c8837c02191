#pragma once

#include <memory>
#include <string>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// What `auto` would take for a scene.
struct Choice {
  enum class Method { piecewise, exponential, rodas4, dopri5 };
  Method method;
  std::string why;
};

/// piecewise for few DOFs with linear stops; exponential where all modes can be had and nothing but the stops couples
/// them; rodas4 for all else, and where it is expected to be done before the modes of a large system are found.
Choice choose(dynamics::Dynamics& dynamics, double tolerance, double end_time);

/// The chosen method with this tolerance; it knows why it was chosen.
std::unique_ptr<time::Integrator> make_automatic(dynamics::Dynamics& dynamics, double tolerance, double end_time);

}  // namespace butee::integrators

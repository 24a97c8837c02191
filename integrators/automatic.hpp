#pragma once

#include <memory>
#include <string>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// What `auto` would take for a scene.
struct Choice {
  enum class Method { exponential, rodas4, exact, dopri5 };
  Method method;
  std::string why;
};

/// exponential where all modes can be had and nothing but the stops couples them, rodas4 for all else, and where it is
/// expected to be done before the modes of a large system are found; exact on one DOF where linear stops are so stiff,
/// or the tolerance so tight, that steps through them would take longer than series from impact to impact.
Choice choose(dynamics::Dynamics& dynamics, double tolerance, double end_time);

/// The chosen method with this tolerance; it knows why it was chosen.
std::unique_ptr<time::Integrator> make_automatic(dynamics::Dynamics& dynamics, double tolerance, double end_time);

}  // namespace butee::integrators

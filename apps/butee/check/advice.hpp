#pragma once

#include <optional>
#include <string>
#include <vector>

#include <butee/dynamics/frequencies.hpp>

#include "../session.hpp"
#include "estimate.hpp"
#include "instability.hpp"
#include "mechanics.hpp"
#include "survey.hpp"

namespace butee::app::check {

/// A likely mistake in the scene and its remedy.
struct Advice {
  std::string about;  ///< identifier for scripts: "critical-step", "output-interval", ...
  std::string text;
};

/// Quantities of a scene that are known before it runs.
struct Facts {
  std::optional<dynamics::FrequencyRange> open, closed;  ///< empty if the eigenvalue solver did not converge
  /// Critical steps of three methods; that of the scene's own method is empty if it is stable at any step.
  std::optional<time::CriticalSteps> of_runge_kutta, of_central_differences, of_method;
  Mechanics mechanics;
  std::optional<Instability> instability;
  Survey survey;
  Estimate cost;
};

std::vector<Advice> advise(const scene::Scene& session, const model::System& system, const Facts& facts);

}  // namespace butee::app::check

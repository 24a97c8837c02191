#pragma once

#include <optional>
#include <string>
#include <vector>

#include <butee/dynamics/frequencies.hpp>

#include "../session.hpp"
#include "estimate.hpp"
#include "mechanics.hpp"
#include "survey.hpp"

namespace butee::app::check {

/// A likely mistake, and what to do about it.
struct Advice {
  std::string about;  ///< a short name for scripts: "critical-step", "output-interval", ...
  std::string text;
};

/// All that is known of a scene before it runs.
struct Facts {
  std::optional<dynamics::FrequencyRange> open, closed;  ///< nothing where the eigenvalue solver did not converge
  Mechanics mechanics;
  Survey survey;
  Estimate cost;
};

std::vector<Advice> advise(const scene::Scene& session, const model::System& system, const Facts& facts);

}  // namespace butee::app::check

#pragma once

#include "../json.hpp"
#include "advice.hpp"

namespace butee::app::check {

/// Prints the contents of the scene and its ignored parts, frequencies, critical steps and cost; `picture` is
/// printed in between.
void print(const scene::Scene& session, const model::System& system, const Facts& facts, const std::string& picture);

Json to_json(const scene::Scene& session, const model::System& system, const Facts& facts,
             const std::vector<Advice>& advice);

}  // namespace butee::app::check

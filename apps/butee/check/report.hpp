#pragma once

#include "../json.hpp"
#include "advice.hpp"

namespace butee::app::check {

/// Prints what the scene holds and skips, its frequencies, critical steps and cost; `picture` goes in between.
void print(const scene::Scene& session, const model::System& system, const Facts& facts, const std::string& picture);

Json to_json(const scene::Scene& session, const model::System& system, const Facts& facts,
             const std::vector<Advice>& advice);

}  // namespace butee::app::check

#pragma once

#include <butee/dynamics/mode_analysis.hpp>
#include <butee/record/result_folder.hpp>

#include "../json.hpp"

namespace butee::app::modes {

using Analysis = dynamics::ModeAnalysis;
using dynamics::Mode;

/// The table for people.
void print(const Analysis& analysis);

Json to_json(const Analysis& analysis);

/// frequencies.csv: a row for each mode.
std::string frequencies_csv(const Analysis& analysis);

/// shapes.csv: a row for each node with its coordinate along its beam (empty for a lone node) and, mode by mode, u and
/// theta (empty where the node has no such DOF), mass-normalised.
std::string shapes_csv(const Analysis& analysis, const model::Model& model, const model::System& system);

/// Draws the shapes of the beams as modes.svg and modes.png in the folder by gnuplot, whose script and data stay. False
/// where gnuplot is missing or failed.
bool draw(const Analysis& analysis, const model::Model& model, const model::System& system,
          const record::ResultFolder& folder);

}  // namespace butee::app::modes

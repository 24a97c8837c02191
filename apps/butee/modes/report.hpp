#pragma once

#include <butee/dynamics/mode_analysis.hpp>
#include <butee/record/result_folder.hpp>

#include "../json.hpp"

namespace butee::app::modes {

using Analysis = dynamics::ModeAnalysis;
using dynamics::Mode;

/// Prints the table of modes.
void print(const Analysis& analysis);

Json to_json(const Analysis& analysis);

/// Writes frequencies.csv, one row for each mode.
std::string frequencies_csv(const Analysis& analysis);

/// Writes shapes.csv: one row for each node with its coordinate along its beam (empty for a lone node) and,
/// for each mode, mass-normalised u and theta (empty if the node has no such DOF).
std::string shapes_csv(const Analysis& analysis, const model::Model& model, const model::System& system);

/// Draws the beam shapes as modes.svg and modes.png in the folder by gnuplot; script and data are kept.
/// Returns false if gnuplot is missing or failed.
bool draw(const Analysis& analysis, const model::Model& model, const model::System& system,
          const record::ResultFolder& folder);

}  // namespace butee::app::modes

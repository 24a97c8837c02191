#pragma once

#include "analysis.hpp"

namespace butee::app::stability {

/// "2.82843", "none up to 10000", "no map beyond 3.1"
std::string text_of(const Limit& limit);

/// Prints a table of the limits.
std::string table(const std::vector<Analysis>& all, const Request& request);

/// Writes method,damping_ratio,h_omega,spectral_radius,numerical_damping,period_error; undefined values are
/// empty.
std::string curves_csv(const std::vector<Analysis>& all);

/// Writes method,stop_ratio,h_omega,spectral_radius.
std::string stops_csv(const std::vector<Analysis>& all);

std::string to_json(const std::vector<Analysis>& all, const Request& request);

/// Writes gnuplot scripts beside the tables and runs them; returns false if gnuplot could not draw.
bool draw(const std::vector<Analysis>& all, const Request& request, const std::string& folder);

}  // namespace butee::app::stability

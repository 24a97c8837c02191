#pragma once

#include "analysis.hpp"

namespace butee::app::stability {

/// "2.82843", "none up to 10000", "no map beyond 3.1"
std::string text_of(const Limit& limit);

/// A table of the limits for people.
std::string table(const std::vector<Analysis>& all, const Request& request);

/// method,damping_ratio,h_omega,spectral_radius,numerical_damping,period_error; empty where there is no such number
std::string curves_csv(const std::vector<Analysis>& all);

/// method,stop_ratio,h_omega,spectral_radius
std::string stops_csv(const std::vector<Analysis>& all);

std::string to_json(const std::vector<Analysis>& all, const Request& request);

/// Writes gnuplot's scripts beside the tables and runs them; false where gnuplot could not draw.
bool draw(const std::vector<Analysis>& all, const Request& request, const std::string& folder);

}  // namespace butee::app::stability

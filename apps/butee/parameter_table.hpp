#pragma once

#include <string>
#include <vector>

#include <butee/config/parameter.hpp>

namespace butee::app {

/// The declared parameters as lines: name, unit, default, allowed values, meaning; with column headings if
/// `headed`. Empty if there are no parameters.
std::string parameter_table(const std::vector<config::Parameter>& parameters, bool headed = true);

}  // namespace butee::app

#pragma once

#include <string>
#include <vector>

namespace butee::app {

/// The cells of a line of CSV. A cell between double quotes may hold commas; the quotes are taken off.
std::vector<std::string> split_csv(const std::string& line);

}  // namespace butee::app

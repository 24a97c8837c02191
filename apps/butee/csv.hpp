#pragma once

#include <string>
#include <vector>

namespace butee::app {

/// The cells of a line of CSV. A cell in double quotes may contain commas; the quotes are removed.
std::vector<std::string> split_csv(const std::string& line);

}  // namespace butee::app

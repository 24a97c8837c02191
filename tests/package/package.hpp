#pragma once

#include <string>

namespace butee::test {

/// Runs a line of shell in `folder`. Its output becomes a failure of the test where it fails.
bool shell(const std::string& folder, const std::string& line);

/// The folder of the package as installed and then moved elsewhere, once for all tests of this process.
const std::string& package();

}  // namespace butee::test

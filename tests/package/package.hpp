#pragma once

#include <string>

namespace butee::test {

/// Runs a shell command in `folder`; on failure its output is reported as a test failure.
bool shell(const std::string& folder, const std::string& line);

/// The folder of the installed package, moved to another place; made once for all tests of this process.
const std::string& package();

}  // namespace butee::test

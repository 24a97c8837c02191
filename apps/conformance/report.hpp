#pragma once

#include <string>
#include <vector>

namespace butee::conformance {

/// The types to test and the options of the report.
struct Request {
  std::string module;              ///< a shared object, or a folder of shared objects
  std::vector<std::string> given;  ///< values of parameters, "KEY=VALUE", for every type that has the key
  std::vector<std::string> only;   ///< names of types; empty: all of the module
  double time_limit = 60.0;        ///< s, for each check
  bool as_json = false;
};

/// Runs every check on every type of a module, each in a separate process, so that a crash or a hang counts
/// as a failure and does not affect other checks; prints the report. Returns true if all passed. Throws
/// InputError if there is nothing to test.
bool test_module(const Request& request);

}  // namespace butee::conformance

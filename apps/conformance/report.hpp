#pragma once

#include <string>
#include <vector>

namespace butee::conformance {

/// What to test, and how to report it.
struct Request {
  std::string module;              ///< a shared object, or a folder of them
  std::vector<std::string> given;  ///< values of parameters, "KEY=VALUE", for every type that has the key
  std::vector<std::string> only;   ///< names of types; empty: all of the module
  double time_limit = 60.0;        ///< s, for each check
  bool as_json = false;
};

/// Runs every check on every type of a module, each in a process of its own, so that one that crashes or hangs counts
/// as failed and stops nobody else; prints the report. True where all passed. Throws InputError where there is nothing
/// to test.
bool test_module(const Request& request);

}  // namespace butee::conformance

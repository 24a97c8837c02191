#pragma once

#include <string>

namespace butee::app {

/// A data folder of the program ("template", "models"), in share/butee beside bin/. Throws RunError if it is
/// missing.
std::string shared_folder(const std::string& name);

/// A program that only `butee` calls, in libexec/butee. Throws RunError if it is missing.
std::string helper_program(const std::string& name);

/// The prefix that CMake needs to find this installation; "" if CMake searches there by default.
std::string package_prefix();

}  // namespace butee::app

#pragma once

#include <string>

namespace butee::app {

/// A folder of what comes with the program ("template", "models"), in share/butee beside bin/. Throws RunError where
/// the installation lacks it.
std::string shared_folder(const std::string& name);

/// A program that only `butee` calls, in libexec/butee. Throws RunError where the installation lacks it.
std::string helper_program(const std::string& name);

/// The prefix that CMake has to be told to find this butee; "" where it looks there by itself.
std::string package_prefix();

}  // namespace butee::app

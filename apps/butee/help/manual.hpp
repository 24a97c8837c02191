#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace butee::app::help {

/// The manual page in roff, generated from the declarations of the commands.
std::string manual_page(const CLI::App& program);

/// An option as text: "-o, --output DIR".
std::string name_of(const CLI::Option& option);

/// The documented options of a command, in the order of declaration.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

}  // namespace butee::app::help

#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace butee::app::help {

/// The manual page in roff, made of the commands' own declarations.
std::string manual_page(const CLI::App& program);

/// What an option is called in text: "-o, --output DIR".
std::string name_of(const CLI::Option& option);

/// The options of a command that people use, in the order of their declaration.
std::vector<const CLI::Option*> options_of(const CLI::App& command);

}  // namespace butee::app::help

#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "program.hpp"
#include "session.hpp"

namespace butee::app {

/// A command of the program and the function that runs it once its options are read.
struct Command {
  CLI::App* app;
  std::function<int()> perform;
};

/// Adds the options that every command with a model file has: MODEL.toml, --set and --plugin.
void add_model_arguments(CLI::App& command, ModelArguments& arguments);

/// Adds --plugin.
void add_plugin_option(CLI::App& command, std::vector<std::string>& plugins);

/// Adds -q, and -v if `with_verbose`. They set the log level as soon as they are parsed.
void add_log_options(CLI::App& command, bool with_verbose);

/// Checks that a number lies between two bounds; messages show these with few digits, as CLI::Range does not.
CLI::Validator between(double lower, double upper);

Command add_run_command(CLI::App& program);
Command add_check_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_study_command(CLI::App& program);
Command add_modes_command(CLI::App& program);
Command add_plot_command(CLI::App& program);
Command add_plugins_command(CLI::App& program);
Command add_new_plugin_command(CLI::App& program);
Command add_test_plugin_command(CLI::App& program);
Command add_stability_command(CLI::App& program);
Command add_init_command(CLI::App& program);
Command add_help_command(CLI::App& program);
Command add_completion_command(CLI::App& program);

}  // namespace butee::app

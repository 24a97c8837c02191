#include "commands.hpp"

#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

namespace butee::app {

void add_plugin_option(CLI::App& command, std::vector<std::string>& plugins) {
  command.add_option("--plugin", plugins, "an additional module, or a folder of modules")
      ->type_name("FILE|DIR")
      ->allow_extra_args(false);
}

CLI::Validator between(double lower, double upper) {
  const auto check = [lower, upper](const std::string& text) -> std::string {
    double value = 0.0;
    if (CLI::detail::lexical_cast(text, value) && value >= lower && value <= upper) return "";
    return text + ": must be a number from " + to_short_text(lower) + " to " + to_short_text(upper);
  };
  return {check, "FLOAT in [" + to_short_text(lower) + " - " + to_short_text(upper) + "]"};
}

void add_model_arguments(CLI::App& command, ModelArguments& arguments) {
  command.add_option("model", arguments.model, "the model file (TOML)")->required()->type_name("MODEL.toml");
  command.add_option("--set", arguments.overrides, "override a key: integrator.time_step=1e-6, contact[0].gap=0.02")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_plugin_option(command, arguments.plugins);
}

void add_log_options(CLI::App& command, bool with_verbose) {
  auto* quiet = command.add_flag_callback(
      "-q,--quiet", [] { log::set_level(log::Level::quiet); },
      "print only warnings, errors and results that go into no file");
  if (with_verbose)
    command
        .add_flag_callback(
            "-v,--verbose", [] { log::set_level(log::Level::verbose); }, "say more")
        ->excludes(quiet);
}

}  // namespace butee::app

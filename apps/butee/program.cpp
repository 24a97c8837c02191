#include "program.hpp"

#include <algorithm>
#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/target.hpp>
#include <butee/core/text.hpp>
#include <butee/version.hpp>

#include "commands.hpp"

namespace butee::app {
namespace {

constexpr const char* kExamples =
    "A first scene:\n"
    "  butee init beam             a commented scene, beam.toml\n"
    "  butee check beam.toml       a picture of it, likely mistakes, the cost of a run\n"
    "  butee run beam.toml         beam-results/history.csv and summary.json\n"
    "\n`butee help TOPIC` explains scenes, methods, results; `butee help` lists the topics.";

/// Refuses empty names of files and folders, as from a variable of the shell that is not set.
void refuse_empty_names(CLI::App& command) {
  const CLI::Validator named(
      [](const std::string& name) { return name.empty() ? std::string("must not be empty") : std::string(); }, "");
  for (const char* option : {"--output", "--picture"})
    if (CLI::Option* const found = command.get_option_no_throw(option)) found->check(named);
}

}  // namespace

int parse_and_run(int argc, char** argv) {
  CLI::App program("butee: transient dynamics of beams and oscillators that strike stops");
  // Checked first: an unavailable BUTEE_TARGET is invalid input for every command.
  program.set_version_flag("--version", "butee " BUTEE_VERSION "\ninstruction set: " + target() + " (available: " +
                                            join(targets()) + "); the rest compiled for " + compiled_for());
  program.require_subcommand(1);
  program.footer(kExamples);
  const std::vector<Command> commands = {
      add_run_command(program),         add_check_command(program),   add_modes_command(program),
      add_compare_command(program),     add_study_command(program),   add_plot_command(program),
      add_stability_command(program),   add_plugins_command(program), add_new_plugin_command(program),
      add_test_plugin_command(program), add_init_command(program),    add_help_command(program),
      add_completion_command(program)};

  std::vector<std::string> known;
  for (const Command& command : commands) {
    known.push_back(command.app->get_name());
    refuse_empty_names(*command.app);
  }
  if (argc > 1 && argv[1][0] != '-' && std::find(known.begin(), known.end(), argv[1]) == known.end())
    throw InputError("butee " + std::string(argv[1]) + ": there is no such command" + suggestion(argv[1], known) +
                     "; known: " + join(known));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    const int status = program.exit(error);
    std::fputs("Keys of a scene are set by --set KEY=VALUE, such as --set integrator.tolerance=1e-3\n", stderr);
    return status == 0 ? kDone : kBadInput;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kDone : kBadInput;
  }
  for (const Command& command : commands)
    if (command.app->parsed()) return command.perform();
  return kBadInput;
}

}  // namespace butee::app

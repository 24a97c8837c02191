#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/version.hpp>

#include "commands.hpp"

namespace {

using namespace butee::app;

void add_model_arguments(CLI::App& command, ModelArguments& arguments) {
  command.add_option("model", arguments.model, "the model file (TOML)")->required()->type_name("MODEL.toml");
  command.add_option("--set", arguments.overrides, "override a key: integrator.time_step=1e-6, contact[0].gap=0.02")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--plugin", arguments.plugins, "a module, or a folder of modules, to be found as well")
      ->type_name("FILE|DIR")
      ->allow_extra_args(false);
}

int parse_and_run(int argc, char** argv) {
  CLI::App program("butee: transient dynamics of beams and oscillators that strike stops");
  program.set_version_flag("--version", "butee " BUTEE_VERSION);
  program.require_subcommand(1);

  RunArguments run;
  bool quiet = false, verbose = false;
  CLI::App* run_app = program.add_subcommand("run", "integrate a model and write its results");
  add_model_arguments(*run_app, run.model);
  run_app->add_option("-o,--output", run.folder, "the folder for the results; <model>-results where not given")
      ->type_name("DIR");
  run_app->add_option("--repeat", run.repeat, "integrate N times and report the fastest")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  run_app->add_flag("--trust", run.trust, "find out how far the answer can be trusted: runs the scene four more times");
  run_app->add_option("--progress", run.progress, "a progress bar")->check(CLI::IsMember({"auto", "always", "never"}));
  auto* quiet_flag = run_app->add_flag("-q,--quiet", quiet, "say nothing but warnings and errors");
  run_app->add_flag("-v,--verbose", verbose, "say more")->excludes(quiet_flag);

  ModelArguments check;
  CLI::App* check_app =
      program.add_subcommand("check", "what a model holds, what it skips, its frequencies and critical steps");
  add_model_arguments(*check_app, check);

  CompareArguments compare;
  CLI::App* compare_app = program.add_subcommand("compare", "run time against error of several integrators");
  add_model_arguments(*compare_app, compare.model);
  compare_app->add_option("-o,--output", compare.folder, "the folder for the results; <stem>-compare where not given")
      ->type_name("DIR");
  compare_app->add_flag("--fresh", compare.fresh, "run again what an earlier call left in the folder");
  compare_app->add_flag("-q,--quiet", quiet, "say nothing but results, warnings and errors");

  PluginsArguments plugins;
  CLI::App* plugins_app =
      program.add_subcommand("plugins", "list what a scene may name: methods, elements, laws, loads");
  plugins_app->add_option("name", plugins.name, "show the parameters of this one")->type_name("NAME");
  plugins_app->add_option("--plugin", plugins.plugins, "a module, or a folder of modules, to be found as well")
      ->type_name("FILE|DIR")
      ->allow_extra_args(false);
  plugins_app->add_option("--write-manifest", plugins.write_manifest, "write the manifest of a module beside it")
      ->type_name("FILE");

  const std::vector<std::string> known = {"run", "check", "compare", "plugins"};
  if (argc > 1 && argv[1][0] != '-' && std::find(known.begin(), known.end(), argv[1]) == known.end())
    throw butee::InputError("butee " + std::string(argv[1]) + ": there is no such command" +
                            butee::suggestion(argv[1], known) + "; known: " + butee::join(known));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kDone : kBadInput;
  }
  if (quiet) butee::log::set_level(butee::log::Level::quiet);
  if (verbose) butee::log::set_level(butee::log::Level::verbose);
  if (run_app->parsed()) return run_command(run);
  if (check_app->parsed()) return check_command(check);
  if (compare_app->parsed()) return compare_command(compare);
  return plugins_command(plugins);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const butee::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    butee::log::error("out of memory");
  } catch (const std::exception& error) {
    butee::log::error(error.what());
  }
  return kFailed;
}

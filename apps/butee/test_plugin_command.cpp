#include <cerrno>
#include <cmath>
#include <cstring>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "commands.hpp"
#include "installation.hpp"

namespace butee::app {
namespace {

/// Replaces this process by the program of the conformance suite, which has its own malloc to count
/// allocations.
int become_suite(const std::vector<std::string>& arguments) {
  const std::string program = helper_program("butee-conformance");
  std::vector<char*> list = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  execv(program.c_str(), list.data());
  throw RunError(program + ": cannot be run: " + std::strerror(errno));
}

struct TestPluginArguments {
  std::string module;
  std::vector<std::string> given, only;
  double time_limit = 60.0;
  bool as_json = false;
};

int test_plugin_command(const TestPluginArguments& arguments) {
  std::vector<std::string> list = {arguments.module, "--time-limit", std::to_string(arguments.time_limit)};
  for (const std::string& assignment : arguments.given) list.insert(list.end(), {"--set", assignment});
  for (const std::string& name : arguments.only) list.insert(list.end(), {"--only", name});
  if (arguments.as_json) list.emplace_back("--json");
  return become_suite(list);
}

}  // namespace

Command add_test_plugin_command(CLI::App& program) {
  const auto arguments = std::make_shared<TestPluginArguments>();
  CLI::App* app = program.add_subcommand("test-plugin", "run the conformance suite on the types of a module");
  app->add_option("module", arguments->module, "a module, or a folder of modules")->required()->type_name("FILE|DIR");
  app->add_option("--set", arguments->given, "a value for a parameter of its types")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app->add_option("--only", arguments->only, "only this type of the module")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app->add_option("--time-limit", arguments->time_limit, "time limit of each check; default 60")
      ->check([](const std::string& text) -> std::string {
        const auto seconds = number_of(text);
        return seconds && std::isfinite(*seconds) && *seconds > 0.0 ? ""
                                                                    : text + ": must be a number of seconds above 0";
      })
      ->type_name("SECONDS");
  app->add_flag("--json", arguments->as_json, "print JSON");
  return {app, [arguments] { return test_plugin_command(*arguments); }};
}

}  // namespace butee::app

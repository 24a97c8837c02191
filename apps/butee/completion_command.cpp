#include <cstdio>

#include <butee/plugin/catalogue.hpp>

#include "commands.hpp"
#include "completion/shells.hpp"
#include "init/kinds.hpp"

namespace butee::app {
namespace {

std::vector<completion::Subjects> subjects() {
  const auto catalogue = plugin::Catalogue::with_plugins();
  std::vector<std::string> methods, kinds;
  for (const auto& entry : catalogue.integrators()) methods.push_back(entry.declaration.name);
  for (const init::Kind& kind : init::kinds()) kinds.emplace_back(kind.name);
  std::vector<std::string> names = methods;
  const auto add = [&](const auto& types) {
    for (const auto& type : types) names.push_back(type.name);
  };
  add(catalogue.types().elements);
  add(catalogue.types().sections);
  add(catalogue.types().laws);
  add(catalogue.types().contacts);
  add(catalogue.types().loads);
  return {{"plugins", std::move(names)}, {"stability", std::move(methods)}, {"init", std::move(kinds)}};
}

int completion_command(const CLI::App& program, const std::string& shell) {
  const auto verbs = completion::verbs_of(program, subjects());
  std::string text = shell == "bash"  ? completion::bash(verbs)
                     : shell == "zsh" ? completion::zsh(verbs)
                                      : completion::fish(verbs);
  std::fputs(text.c_str(), stdout);
  return kDone;
}

}  // namespace

Command add_completion_command(CLI::App& program) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand("completion", "print a completion script for a shell");
  app->add_option("shell", *shell, "the shell: source <(butee completion bash)")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  return {app, [shell, &program] { return completion_command(program, *shell); }};
}

}  // namespace butee::app

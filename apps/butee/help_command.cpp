#include <cstdio>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "commands.hpp"
#include "help/manual.hpp"
#include "help/topics.hpp"

namespace butee::app {
namespace {

struct HelpArguments {
  std::string topic;
  bool man = false;
};

std::string overview(const CLI::App& program) {
  std::string text = program.help() + "\nTopics of `butee help TOPIC`:\n";
  for (const help::Topic& topic : help::topics())
    text += "  " + topic.name + std::string(topic.name.size() < 27 ? 27 - topic.name.size() : 1, ' ') + topic.summary +
            "\n";
  return text;
}

/// True for the name of a method, an element or another type.
bool is_type_name(const std::string& name) {
  const auto catalogue = plugin::Catalogue::with_plugins();
  const auto has = [&name](const auto& types) {
    return std::any_of(types.begin(), types.end(), [&](const auto& type) { return type.name == name; });
  };
  const auto& types = catalogue.types();
  return catalogue.find(name) != nullptr || has(types.elements) || has(types.sections) || has(types.laws) ||
         has(types.contacts) || has(types.loads) || has(types.formats);
}

int help_command(const CLI::App& program, const HelpArguments& arguments) {
  std::string text;
  std::vector<std::string> known;
  for (const help::Topic& topic : help::topics()) {
    known.push_back(topic.name);
    if (topic.name == arguments.topic) text = topic.text(plugin::Catalogue::with_plugins());
  }
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (std::find(known.begin(), known.end(), command->get_name()) == known.end()) known.push_back(command->get_name());
    if (command->get_name() != arguments.topic) continue;
    text += (text.empty() ? "" : "\n") + command->help("butee");
  }
  if (arguments.topic.empty()) text = arguments.man ? help::manual_page(program) : overview(program);
  if (text.empty())
    throw InputError("butee help " + arguments.topic + ": there is no such topic or command" +
                     (is_type_name(arguments.topic) ? "; `butee plugins " + arguments.topic + "` explains it"
                                                    : suggestion(arguments.topic, known)) +
                     "; known: " + join(known));
  std::fputs(text.c_str(), stdout);
  return kDone;
}

}  // namespace

Command add_help_command(CLI::App& program) {
  const auto arguments = std::make_shared<HelpArguments>();
  CLI::App* app = program.add_subcommand("help", "explain a topic or a command; without one, list them");
  auto* topic = app->add_option("topic", arguments->topic, "the topic or command")->type_name("TOPIC|COMMAND");
  app->add_flag("--man", arguments->man, "the whole manual page, in roff")->excludes(topic);
  return {app, [arguments, &program] { return help_command(program, *arguments); }};
}

}  // namespace butee::app

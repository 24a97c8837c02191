#include <sstream>

#include "../help/manual.hpp"
#include "../help/topics.hpp"
#include "shells.hpp"

namespace butee::app::completion {
namespace {

/// Determined from the type name shown by --help: DIR, FILE, MODEL.toml, or {a,b,c}.
Values values_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{'), close = type.find('}');
  Values values;
  if (open != std::string::npos && close != std::string::npos) {
    values.kind = Values::Kind::words;
    std::istringstream list(type.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(list, word, ',');) values.words.push_back(word);
  } else if (type.find(".toml") != std::string::npos) {
    values.kind = Values::Kind::scenes;
  } else if (type == "DIR") {
    values.kind = Values::Kind::folders;
  } else if (type.find("FILE") != std::string::npos) {
    values.kind = Values::Kind::files;
  }
  return values;
}

}  // namespace

std::vector<Verb> verbs_of(const CLI::App& program, const std::vector<Subjects>& given) {
  std::vector<Verb> verbs;
  std::vector<std::string> subjects;
  for (const help::Topic& topic : help::topics()) subjects.push_back(topic.name);
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    Verb verb;
    verb.name = command->get_name();
    verb.description = command->get_description();
    subjects.push_back(verb.name);
    for (const CLI::Option* option : help::options_of(*command)) {
      if (option->get_positional()) {
        verb.argument = values_of(*option);
        continue;
      }
      Flag flag;
      for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
      flag.description = option->get_description();
      flag.takes_value = option->get_items_expected_max() > 0;
      if (flag.takes_value) flag.values = values_of(*option);
      verb.flags.push_back(std::move(flag));
    }
    verbs.push_back(std::move(verb));
  }
  for (Verb& verb : verbs) {
    if (verb.name == "help") verb.argument = {Values::Kind::words, subjects};
    for (const Subjects& one : given)
      if (verb.name == one.command) verb.argument = {Values::Kind::words, one.words};
  }
  return verbs;
}

}  // namespace butee::app::completion

#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace butee::app::completion {

/// Words that may follow an option, or be an argument of a command.
struct Values {
  enum class Kind { nothing, words, folders, files, scenes } kind = Kind::nothing;
  std::vector<std::string> words;
};

struct Flag {
  std::vector<std::string> names;  ///< "-o", "--output"
  std::string description;
  bool takes_value = false;
  Values values;
};

struct Verb {
  std::string name, description;
  std::vector<Flag> flags;
  Values argument;
};

/// The words that a command takes as its argument.
struct Subjects {
  std::string command;
  std::vector<std::string> words;
};

/// The commands as shell completion needs them. `help` takes topics and commands, others the words given here.
std::vector<Verb> verbs_of(const CLI::App& program, const std::vector<Subjects>& given);

std::string bash(const std::vector<Verb>& verbs);
std::string zsh(const std::vector<Verb>& verbs);
std::string fish(const std::vector<Verb>& verbs);

}  // namespace butee::app::completion

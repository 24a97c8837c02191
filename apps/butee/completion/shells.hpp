#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace butee::app::completion {

/// What may follow an option, or stand as the argument of a command.
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

/// The commands as a shell's completion sees them. `topics` and `names` may follow `help` and `plugins`, `kinds`
/// `init`.
std::vector<Verb> verbs_of(const CLI::App& program, const std::vector<std::string>& names,
                           const std::vector<std::string>& kinds);

std::string bash(const std::vector<Verb>& verbs);
std::string zsh(const std::vector<Verb>& verbs);
std::string fish(const std::vector<Verb>& verbs);

}  // namespace butee::app::completion

#include "shells.hpp"

#include <butee/core/text.hpp>

namespace butee::app::completion {
namespace {

std::string words_of(const std::vector<std::string>& words) {
  return butee::join(words, " ");
}

/// Quotes text in single quotes for a shell.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string bash_of(const Values& values) {
  switch (values.kind) {
    case Values::Kind::nothing:
      return "";
    case Values::Kind::words:
      return "COMPREPLY=($(compgen -W " + quoted(words_of(values.words)) + " -- \"$cur\"))";
    case Values::Kind::folders:
      return "COMPREPLY=($(compgen -d -- \"$cur\"))";
    case Values::Kind::files:
      return "COMPREPLY=($(compgen -f -- \"$cur\"))";
    case Values::Kind::scenes:
      break;
  }
  return "COMPREPLY=($(compgen -f -X '!*.toml' -- \"$cur\") $(compgen -d -- \"$cur\"))";
}

/// Escapes colons and brackets, which are separators in zsh's notation.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_of(const Values& values) {
  switch (values.kind) {
    case Values::Kind::nothing:
      return ":value: ";
    case Values::Kind::words:
      return ":value:(" + words_of(values.words) + ")";
    case Values::Kind::folders:
      return ":folder:_files -/";
    case Values::Kind::files:
      return ":file:_files";
    case Values::Kind::scenes:
      break;
  }
  return ":scene:_files -g \"*.toml\"";
}

std::string fish_of(const Values& values) {
  switch (values.kind) {
    case Values::Kind::nothing:
      return " -x";
    case Values::Kind::words:
      return " -x -a " + quoted(words_of(values.words));
    case Values::Kind::folders:
      return " -x -a '(__fish_complete_directories)'";
    case Values::Kind::files:
      return " -r -F";
    case Values::Kind::scenes:
      break;
  }
  return " -x -a '(__fish_complete_suffix .toml)'";
}

}  // namespace

std::string bash(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  std::string cases;
  for (const Verb& verb : verbs) {
    names.push_back(verb.name);
    std::vector<std::string> flags;
    std::string after;
    for (const Flag& flag : verb.flags) {
      flags.insert(flags.end(), flag.names.begin(), flag.names.end());
      if (flag.takes_value)
        after += "        " + butee::join(flag.names, "|") + ") " + bash_of(flag.values) +
                 (flag.values.kind == Values::Kind::nothing ? "" : "; ") + "return ;;\n";
    }
    cases += "    " + verb.name + ")\n      case \"$prev\" in\n" + after +
             "      esac\n      if [[ \"$cur\" == -* ]]; then\n        COMPREPLY=($(compgen -W " +
             quoted(words_of(flags)) + " -- \"$cur\"))\n      else\n        " +
             (verb.argument.kind == Values::Kind::nothing ? ":" : bash_of(verb.argument)) + "\n      fi ;;\n";
  }
  return "# bash completion for butee; made by `butee completion bash`\n_butee() {\n"
         "  local cur=\"${COMP_WORDS[COMP_CWORD]}\" prev=\"${COMP_WORDS[COMP_CWORD-1]}\" verb=\"\" i\n"
         "  COMPREPLY=()\n"
         "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
         "    if [[ \"${COMP_WORDS[i]}\" != -* ]]; then verb=\"${COMP_WORDS[i]}\"; break; fi\n  done\n"
         "  case \"$verb\" in\n    '') COMPREPLY=($(compgen -W " +
         quoted(words_of(names) + " --help --version") + " -- \"$cur\")) ;;\n" + cases +
         "  esac\n}\ncomplete -o filenames -F _butee butee\n";
}

std::string zsh(const std::vector<Verb>& verbs) {
  std::string list, cases;
  for (const Verb& verb : verbs) {
    list += "    " + quoted(verb.name + ":" + verb.description) + "\n";
    cases += "    " + verb.name + ")\n      _arguments";
    for (const Flag& flag : verb.flags)
      for (const std::string& name : flag.names)
        cases += " \\\n        " + quoted("*" + name + "[" + zsh_text(flag.description) + "]" +
                                          (flag.takes_value ? zsh_of(flag.values) : ""));
    if (verb.argument.kind != Values::Kind::nothing) cases += " \\\n        " + quoted("*" + zsh_of(verb.argument));
    cases += " ;;\n";
  }
  return "#compdef butee\n# zsh completion for butee; made by `butee completion zsh`\n_butee() {\n  local -a verbs\n  "
         "verbs=(\n" +
         list +
         "  )\n  if (( CURRENT == 2 )); then\n    _describe command verbs\n    return\n  fi\n"
         "  local verb=${words[2]}\n  shift words\n  (( CURRENT-- ))\n  case \"$verb\" in\n" +
         cases +
         "  esac\n}\nif [ \"$funcstack[1]\" = \"_butee\" ]; then _butee \"$@\"; else compdef _butee butee; fi\n";
}

std::string fish(const std::vector<Verb>& verbs) {
  std::string text = "# fish completion for butee; made by `butee completion fish`\ncomplete -c butee -f\n";
  for (const Verb& verb : verbs) {
    text += "complete -c butee -n __fish_use_subcommand -a " + verb.name + " -d " + quoted(verb.description) + "\n";
    const std::string start = "complete -c butee -n '__fish_seen_subcommand_from " + verb.name + "'";
    for (const Flag& flag : verb.flags) {
      text += start;
      for (const std::string& name : flag.names)
        text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      text += (flag.takes_value ? fish_of(flag.values) : "") + " -d " + quoted(flag.description) + "\n";
    }
    if (verb.argument.kind != Values::Kind::nothing) text += start + fish_of(verb.argument) + "\n";
  }
  return text;
}

}  // namespace butee::app::completion

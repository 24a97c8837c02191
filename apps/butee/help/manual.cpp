#include "manual.hpp"

#include <butee/plugin/catalogue.hpp>
#include <butee/version.hpp>

#include "topics.hpp"

namespace butee::app::help {
namespace {

/// Escapes text for roff: no line starts with a command, and hyphens are not line breaks.
std::string escaped(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

std::string section(const std::string& title) {
  return ".SH " + title + "\n";
}

std::string item(const std::string& term, const std::string& text) {
  return ".TP\n.B " + escaped(term) + "\n" + escaped(text) + "\n";
}

/// "DIR", or "{bash,zsh,fish}" if only certain words are allowed.
std::string type_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto checks = type.find(':');
  if (checks == std::string::npos) return type;
  return type.rfind("TEXT:", 0) == 0 ? type.substr(checks + 1) : type.substr(0, checks);
}

std::string positionals_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += option->get_required() ? " " + type_of(*option) : " [" + type_of(*option) + "]";
  return text;
}

}  // namespace

std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return type_of(option);
  std::string text;
  for (const std::string& name : option.get_snames()) text += (text.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames()) text += (text.empty() ? "--" : ", --") + name;
  if (option.get_items_expected_max() == 0) return text;
  return text + " " + type_of(option);
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty()) options.push_back(option);
  return options;
}

std::string manual_page(const CLI::App& program) {
  std::string text = ".TH BUTEE 1 \"\" \"butee " BUTEE_VERSION "\" \"User Commands\"\n";
  text +=
      section("NAME") + "butee \\- " + escaped("transient dynamics of beams and oscillators that strike stops") + "\n";
  text += section("SYNOPSIS") + ".B butee\n.I COMMAND\n[\\fIOPTION\\fR]...\n";
  text += section("DESCRIPTION") +
          escaped(
              "Computes the motion of a scene, a TOML file with beams, masses, springs, stops and loads, and "
              "estimates its accuracy. \"butee help TOPIC\" explains the contents of a scene.") +
          "\n";
  text += section("COMMANDS");
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    text += ".SS \"butee " + escaped(command->get_name() + positionals_of(*command)) + "\"\n" +
            escaped(command->get_description()) + "\n";
    for (const CLI::Option* option : options_of(*command)) text += item(name_of(*option), option->get_description());
  }
  text += section("TOPICS OF BUTEE HELP");
  for (const Topic& topic : topics()) text += item(topic.name, topic.summary);
  const plugin::Catalogue none;
  text += section("EXIT STATUS") + ".nf\n" + escaped(exit_codes_text(none)) + ".fi\n";
  text += section("ENVIRONMENT") + ".nf\n" + escaped(environment_text(none)) + ".fi\n";
  text += section("EXAMPLES") + ".nf\n" +
          escaped(
              "butee init beam\nbutee check beam.toml\nbutee modes beam.toml -n 6\nbutee run beam.toml --trust\n"
              "butee run beam.toml --set integrator.type=newmark --set integrator.time_step=1e-4 -o newmark\n"
              "butee compare beam.toml\n") +
          ".fi\n";
  return text;
}

}  // namespace butee::app::help

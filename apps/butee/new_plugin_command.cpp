#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <butee/core/error.hpp>
#include <butee/plugin/catalogue.hpp>
#include <butee/version.hpp>

#include "commands.hpp"
#include "installation.hpp"

namespace butee::app {
namespace {

namespace fs = std::filesystem;

struct NewPluginArguments {
  std::string name, kind = "integrator", folder;
};

/// "my_method" -> "MyMethod"
std::string type_name(const std::string& name) {
  std::string type;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') type += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return type;
}

void check_name(const std::string& name) {
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const bool fits = !name.empty() && is_lower(name.front()) && std::all_of(name.begin(), name.end(), [&](char c) {
    return is_lower(c) || (c >= '0' && c <= '9') || c == '_';
  });
  if (!fits)
    throw InputError("NAME = \"" + name +
                     "\": must be lower-case letters, digits and _, beginning with a letter: it becomes a C++ name and "
                     "the name in scenes, such as my_method");
  static constexpr std::array kTaken = {"butee",  "std", "auto",  "stop", "friction", "distributed",
                                        "double", "int", "class", "new",  "long"};
  if (std::find(kTaken.begin(), kTaken.end(), name) != kTaken.end())
    throw InputError("NAME = \"" + name + "\": is a keyword of C++ or a name of butee; choose another one");
}

/// A module with a name in use would not load beside the other one.
void check_is_free(const NewPluginArguments& arguments) {
  const plugin::Catalogue catalogue = plugin::Catalogue::with_plugins();
  const model::ModelTypes& types = catalogue.types();
  const std::vector<std::string> taken = arguments.kind == "integrator" ? catalogue.integrator_names()
                                         : arguments.kind == "law"      ? type_names(types.laws)
                                         : arguments.kind == "contact"  ? type_names(types.contacts)
                                         : arguments.kind == "load"     ? type_names(types.loads)
                                                                        : type_names(types.elements);
  if (std::find(taken.begin(), taken.end(), arguments.name) != taken.end())
    throw InputError("NAME = \"" + arguments.name + "\": is the name of another " + arguments.kind +
                     "; choose another one (`butee plugins` lists those of modules)");
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

/// Writes the files of the template's folder without the ending ".in".
void write_files(const fs::path& from, const fs::path& to, const NewPluginArguments& arguments) {
  for (const auto& entry : fs::directory_iterator(from)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".in") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    std::string made = replaced(text.str(), "@NAME@", arguments.name);
    made = replaced(made, "@TYPE@", type_name(arguments.name));
    made = replaced(made, "@KIND@", arguments.kind);
    made = replaced(made, "@VERSION@", BUTEE_VERSION);
    const std::string file = replaced(entry.path().stem().string(), "name.", arguments.name + ".");
    std::ofstream out(to / file, std::ios::binary);
    out << made;
    out.close();
    if (!out) throw RunError((to / file).string() + ": cannot be written");
  }
}

int new_plugin_command(const NewPluginArguments& arguments) {
  check_name(arguments.name);
  check_is_free(arguments);
  const fs::path folder = arguments.folder.empty() ? arguments.name : arguments.folder;
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw InputError(folder.string() + ": exists already; choose another folder with -o, or remove it");
  const fs::path source = shared_folder("template");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw InputError(folder.string() + ": cannot be made: " + error.message() + "; choose another folder with -o");
  write_files(source, folder, arguments);
  write_files(source / arguments.kind, folder, arguments);
  std::printf("%s: a module with the %s \"%s\". Next:\n\n", folder.c_str(), arguments.kind.c_str(),
              arguments.name.c_str());
  const std::string prefix = package_prefix();
  std::printf("    cd %s\n    cmake -B build%s\n    cmake --build build\n    ctest --test-dir build\n", folder.c_str(),
              prefix.empty() ? "" : (" -D CMAKE_PREFIX_PATH=" + prefix).c_str());
  std::printf("    butee run scene.toml --plugin build/%s.so\n", arguments.name.c_str());
  return kDone;
}

}  // namespace

Command add_new_plugin_command(CLI::App& program) {
  const auto arguments = std::make_shared<NewPluginArguments>();
  CLI::App* app = program.add_subcommand("new-plugin", "write a small project that builds a module of your own");
  app->add_option("name", arguments->name, "the name in scenes: lower-case letters, digits and _")
      ->required()
      ->type_name("NAME");
  app->add_option("--kind", arguments->kind, "the kind of module; default integrator")
      ->check(CLI::IsMember({"integrator", "law", "contact", "load", "element"}));
  app->add_option("-o,--output", arguments->folder, "the folder for the project; default NAME")->type_name("DIR");
  return {app, [arguments] { return new_plugin_command(*arguments); }};
}

}  // namespace butee::app

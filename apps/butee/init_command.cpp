#include <cstdio>
#include <filesystem>
#include <fstream>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "commands.hpp"
#include "init/kinds.hpp"

namespace butee::app {
namespace {

struct InitArguments {
  std::string kind;
  std::string file;  ///< empty: KIND.toml
};

int list_kinds() {
  for (const init::Kind& kind : init::kinds())
    std::printf("  %-16s %s\n", std::string(kind.name).c_str(), std::string(kind.summary()).c_str());
  return kDone;
}

int init_command(const InitArguments& arguments) {
  if (arguments.kind.empty()) return list_kinds();
  const init::Kind* wanted = nullptr;
  std::vector<std::string> known;
  for (const init::Kind& kind : init::kinds()) {
    known.emplace_back(kind.name);
    if (kind.name == arguments.kind) wanted = &kind;
  }
  if (wanted == nullptr)
    throw InputError("butee init " + arguments.kind + ": there is no such kind" + suggestion(arguments.kind, known) +
                     "; known: " + join(known));
  const std::string path = arguments.file.empty() ? arguments.kind + ".toml" : arguments.file;
  if (std::filesystem::exists(path))
    throw InputError(path + ": exists and is not overwritten; choose another name with -o");
  std::ofstream file(path, std::ios::binary);
  file << wanted->text;
  file.close();
  if (!file) throw RunError(path + ": cannot be written");
  std::printf("%s: %s\n  butee check %s\n  butee run %s\n", path.c_str(), std::string(wanted->summary()).c_str(),
              path.c_str(), path.c_str());
  return kDone;
}

}  // namespace

Command add_init_command(CLI::App& program) {
  const auto arguments = std::make_shared<InitArguments>();
  CLI::App* app = program.add_subcommand("init", "write a commented scene to start from; without a kind, list them");
  app->add_option("kind", arguments->kind, "the kind of scene")->type_name("KIND");
  app->add_option("-o,--output", arguments->file, "the file; default KIND.toml")->type_name("FILE");
  return {app, [arguments] { return init_command(*arguments); }};
}

}  // namespace butee::app
